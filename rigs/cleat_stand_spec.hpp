// A cleat test stand as an entry of the table of rigs: the drawbar rig (drawbar_rig.hpp) with a freely rolling wheel
// that a damper lets down on its load, and whose axle is then held at the height where it stands.
#pragma once

#include <memory>

#include <nlohmann/json_fwd.hpp>

#include "protocol/core/fields.hpp"
#include "protocol/files/read_context.hpp"
#include "rigs/rig_spec.hpp"

namespace furrow::rigs {

/// Every field is the scenario key `rig.<name>`. What is negative here is open: RigSpec::mount fills it in.
struct CleatStandOptions {
  double speed = 4.0;              // of the axle, m/s
  double ramp = 0.15;              // smooth (C²) start from rest, s; 0: full speed from t = 0
  double move_from = 0.0;          // when it starts, s
  double hold_axle_from = 0.5;     // until then the wheel is let down, from then on its axle keeps its height, s
  double lowering_speed = -1.0;    // at which it is let down, m/s
  double start = 0.0;              // x of the axle at t = 0, m; where the scenario does not say it, it is filled in
  double load = -1.0;              // weight of all that the ground carries, tire included, until the axle is held, N
  double carrier_mass = -1.0;      // wheel carrier with ballast, kg; in place of the load
  double rim_mass = -1.0;          // kg
  double rim_spin_inertia = -1.0;  // kg m², about the axle
  double rim_diametral_inertia = -1.0;  // kg m²
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<CleatStandOptions> auto& s) {
  visit(Field{"speed", "m/s", role::key}, s.speed);
  visit(Field{"ramp", "s", role::key}, s.ramp);
  visit(Field{"move_from", "s", role::key}, s.move_from);
  visit(Field{"hold_axle_from", "s", role::key}, s.hold_axle_from);
  visit(Field{"lowering_speed", "m/s", role::key}, s.lowering_speed);
  visit(Field{"start", "m", role::key}, s.start);
  visit(Field{"load", "N", role::key}, s.load);
  visit(Field{"carrier_mass", "kg", role::key}, s.carrier_mass);
  visit(Field{"rim_mass", "kg", role::key}, s.rim_mass);
  visit(Field{"rim_spin_inertia", "kg m²", role::key}, s.rim_spin_inertia);
  visit(Field{"rim_diametral_inertia", "kg m²", role::key}, s.rim_diametral_inertia);
}

/// @pre the section was checked against the schema. @throws Error(bad_input) naming file and key
std::unique_ptr<RigSpec> read_cleat_stand(const nlohmann::json& section, const ReadContext& context);

}  // namespace furrow::rigs
