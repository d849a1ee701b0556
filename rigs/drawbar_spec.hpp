// The drawbar rig as an entry of the table of rigs, and several of them side by side on one terrain (rig.wheels).
#pragma once

#include <memory>
#include <vector>

#include "protocol/files/json_fields.hpp"
#include "protocol/files/read_context.hpp"
#include "rigs/drawbar_rig.hpp"
#include "rigs/rig_spec.hpp"

namespace furrow::rigs {

/// One of several wheels: what its entry of `rig.wheels` says, and for the rest what the rig says.
struct DrawbarWheel {
  DrawbarRigOptions rig;
};

template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<DrawbarWheel> auto& s) {
  visit(Field{"lateral", "m", role::key}, s.rig.lateral);
  visit(Field{"start", "m", role::key}, s.rig.start);
  visit(Field{"slip", "-", role::key}, s.rig.slip);
  visit(Field{"toe_angle", "rad", role::key}, s.rig.toe_angle);
  visit(Field{"camber_angle", "rad", role::key}, s.rig.camber_angle);
  visit(Field{"load", "N", role::key}, s.rig.load);
  visit(Field{"carrier_mass", "kg", role::key}, s.rig.carrier_mass);
}

/// Those of DrawbarRigOptions, and the list `wheels`.
std::vector<Field> drawbar_fields();

/// @throws Error(bad_input) naming file and key
std::unique_ptr<RigSpec> read_drawbar(const nlohmann::json& section, const ReadContext& context);

/// One rig per wheel, each as its options say. @pre there is at least one
std::unique_ptr<RigSpec> drawbar_spec(std::vector<DrawbarRigOptions> rigs);

}  // namespace furrow::rigs
