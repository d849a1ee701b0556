// The keys of the section `terrain` with engine rigid, hard ground: each field is the key of its name.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "protocol/core/fields.hpp"
#include "protocol/core/key.hpp"
#include "terrain/rigid/ground_profile.hpp"
#include "terrain/terrain_keys.hpp"
#include "terrain/terrain_spec.hpp"

namespace furrow::terrain {

struct HeightMap;

/// A stiff elastic layer: pressure = stiffness × depth + damping × its rate. The keys, and what the run supplies.
struct GroundOptions : TerrainContext {
  std::string scenario = "scenario";      // what messages name: the scenario's file
  double friction = 0.9;                  // -, at most the tire's
  double friction_velocity_scale = 5.0;   // c in F_t = μ N tanh(c |v_t|), s/m
  double ground_stiffness = 4e8;          // N/m³: 0.6 mm under 240 kPa; 4e5 N/m on a vertex that carries 10 cm²
  double ground_shear_stiffness = 1e8;    // N/m³: a tread of 1 MPa shear modulus, 10 mm thick
  double ground_damping = 2.5e4;          // N s/m³: holds such a vertex of 2.8 g on its own up to H = 4e-5 s
  ProfilePoints profile;                  // z at x; empty: the plane z = 0
  std::string profile_file;               // CSV or OpenCRG, in place of `profile`
  bool profile_across = true;             // heights of the file may change across; false: they are those at profile_v
  std::string profile_line = "straight";  // how the reference line of OpenCRG lies
  double profile_v = 0.0;                 // of the file where y = 0, m
  double profile_from = -1.0;             // x where the file's first height lies, m; negative: where the file says
  std::shared_ptr<const HeightMap> map;   // of the file, where heights change across: in place of `profile`
  std::vector<std::pair<std::string, std::string>> remarks;  // of the file (GroundShape)
  std::string road_class;                                    // of ISO 8608, A to H, in place of `profile`
  double road_from = 5.0;                                    // x where it begins, m
  double road_length = 100.0;                                // m
};
void visit_fields(FieldsOf<GroundOptions> auto& s, auto&& visit) {
  using namespace allowed;
  visit(s.friction, keys::kFriction);
  visit(s.friction_velocity_scale, keys::kFrictionVelocityScale);
  visit(s.ground_stiffness, key("ground_stiffness", "N/m³", above(0).to(1e15), "Pressure per depth, engine rigid."));
  visit(s.ground_shear_stiffness, key("ground_shear_stiffness", "N/m³", above(0).to(1e15),
                                      "Shear traction per displacement of a tread that sticks, engine rigid."));
  visit(s.ground_damping, key("ground_damping", "N s/m³", from(0, 1e12),
                              "Pressure per rate of depth, and shear traction per rate of shear, engine rigid."));
  visit(
      s.profile,
      key("profile", "m",
          shaped(R"({"type": "array", "minItems": 1, "maxItems": 100000, "entries": "[x, z] in m",
                      "items": {"type": "array", "minItems": 2, "maxItems": 2,
                                "items": {"type": "number", "minimum": -1e6, "maximum": 1e6}}})")
              .or_null(),
          "Height z of the ground at x, alike for all y, engine rigid: straight between the entries, level before the "
          "first and after the last. Two entries at one x are an upright face, such as a curb. null: the plane z = "
          "0."));
  visit(s.profile_file, keys::kProfileFile);
  visit(s.profile_across, keys::kProfileAcross);
  visit(s.profile_line, keys::kProfileLine);
  visit(s.profile_v, keys::kProfileV);
  visit(s.profile_from, keys::kProfileFrom);
  visit(s.road_class,
        key("road_class", "", words("A B C D E F G H").or_null(),
            "Class of a random road after ISO 8608, from A (very smooth) to H, in place of profile, engine rigid. "
            "run.seed draws its heights; it is level before road_from and after its end. null: no such road."));
  visit(s.road_from,
        key("road_from", "m", from(-1e6, 1e6),
            "x where the road of road_class begins, engine rigid. Its heights swell from 0 over 5 m, or a tenth of its "
            "length where that is less."));
  visit(s.road_length,
        key("road_length", "m", from(1, 4999),
            "Length of the road of road_class, engine rigid. The longest wave in it is 91 m, the shortest 0.35 m."));
}

}  // namespace furrow::terrain
