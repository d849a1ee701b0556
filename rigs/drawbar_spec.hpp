// The drawbar rig as an entry of the table of rigs, and several of them side by side on one terrain (rig.wheels).
#pragma once

#include <memory>
#include <type_traits>
#include <vector>

#include <nlohmann/json.hpp>

#include "protocol/core/key.hpp"
#include "protocol/files/json_fields.hpp"
#include "protocol/files/read_context.hpp"
#include "rigs/drawbar_rig.hpp"
#include "rigs/rig_spec.hpp"

namespace furrow::rigs {

/// One of several wheels: its entry of `rig.wheels`, with the keys of the rig where the entry gives none.
struct DrawbarWheel {
  static constexpr SchemaName kSchema{"wheel",
                                      "One of several wheels, each on a rig of its own over the same terrain."};
  DrawbarRigOptions rig;
};

void visit_fields(FieldsOf<DrawbarWheel> auto& s, auto&& visit) {
  using namespace allowed;
  visit(s.rig.lateral,
        key("lateral", "m", from(-1e3, 1e3), "Place along y of the wheel's mid-plane. The bin's is y = 0."));
  visit(s.rig.start,
        key("start", "m", from(-1e6, 1e6).or_null(), "Place along x of the axle at t = 0. null: as rig.start."));
  visit(s.rig.slip, key("slip", "-", from(-10, 1).or_null(), "Slip of this wheel. null: as rig.slip."));
  visit(s.rig.toe_angle, key("toe_angle", "rad", from(-1.5, 1.5).usual(-0.5, 0.5).or_null(),
                             "Toe angle of this wheel. null: as rig.toe_angle."));
  visit(s.rig.camber_angle, key("camber_angle", "rad", from(-0.7, 0.7).usual(-0.3, 0.3).or_null(),
                                "Camber angle of this wheel. null: as rig.camber_angle."));
  visit(s.rig.load, key("load", "N", above(0).to(1e7).usual(1, 200000).or_null(),
                        "Load of this wheel. null: as the rig states, unless carrier_mass is given here."));
  visit(s.rig.carrier_mass, key("carrier_mass", "kg", above(0).to(1e6).usual(0.1, 20000).or_null(),
                                "Carrier mass of this wheel. null: as the rig states, unless load is given here."));
}

/// Keys of the section: those of every wheel, and the list of differing keys of single wheels.
struct DrawbarKeys : DrawbarRigOptions {
  nlohmann::json wheels = nlohmann::json::array();  // each with the keys of DrawbarWheel
};

void visit_fields(FieldsOf<DrawbarKeys> auto& s, auto&& visit) {
  using namespace allowed;
  using Base = std::conditional_t<std::is_const_v<std::remove_reference_t<decltype(s)>>, const DrawbarRigOptions,
                                  DrawbarRigOptions>;
  visit_fields(static_cast<Base&>(s), visit);
  visit(s.wheels,
        key("wheels", "",
            shaped(R"({"type": "array", "minItems": 0, "maxItems": 64, "items": {"$ref": "#/definitions/wheel"}})"),
            "Several wheels side by side or one behind the other, one entry each. A key that an entry leaves out has "
            "the value of the section. Empty: one wheel."));
}

/// @throws Error(bad_input) naming file and key
std::unique_ptr<RigSpec> read_drawbar(const nlohmann::json& section, const ReadContext& context);

/// Returns a spec with one rig per wheel. @pre there is at least one
std::unique_ptr<RigSpec> drawbar_spec(std::vector<DrawbarRigOptions> rigs);

}  // namespace furrow::rigs
