// The cleat test stand as an entry of the table of rigs: the drawbar rig (drawbar_rig.hpp) with a freely rolling wheel.
// A damper lowers the wheel until it rests on its load; then the axle is held at that height.
#pragma once

#include <memory>

#include <nlohmann/json_fwd.hpp>

#include "protocol/core/fields.hpp"
#include "protocol/core/key.hpp"
#include "protocol/files/read_context.hpp"
#include "rigs/rig_keys.hpp"
#include "rigs/rig_spec.hpp"

namespace furrow::rigs {

/// Every field is the scenario key `rig.<name>`. A negative value is open: RigSpec::mount fills it in.
struct CleatStandOptions : RailOptions {
  double hold_axle_from = 0.5;  // s; the wheel is lowered until then, and its axle keeps its height afterwards
  double carrier_mass = -1.0;   // wheel carrier with ballast, kg; instead of the load
};
void visit_fields(FieldsOf<CleatStandOptions> auto& s, auto&& visit) {
  using namespace allowed;
  visit(s.speed, keys::kSpeed);
  visit(s.ramp, keys::kRamp);
  visit(s.move_from, keys::kMoveFrom);
  visit(s.hold_axle_from,
        key("hold_axle_from", "s", from(0, 1e5),
            "Until then the damper lets the wheel of a cleat test stand down; from then on a stop holds its axle at "
            "the height where it stands on its load."));
  visit(s.lowering_speed, keys::kLoweringSpeed);
  visit(s.start, keys::kStart);
  visit(s.load, keys::kLoad);
  visit(s.carrier_mass, keys::kCarrierMass);
  visit(s.rim_mass, keys::kRimMass);
  visit(s.rim_spin_inertia, keys::kRimSpinInertia);
  visit(s.rim_diametral_inertia, keys::kRimDiametralInertia);
}

/// @pre the section was checked against the schema. @throws Error(bad_input) naming file and key
std::unique_ptr<RigSpec> read_cleat_stand(const nlohmann::json& section, const ReadContext& context);

}  // namespace furrow::rigs
