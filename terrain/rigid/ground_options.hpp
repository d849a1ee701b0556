// The keys of the section `terrain` with engine rigid, hard ground: each field is the key of its name.
#pragma once

#include <string>

#include "protocol/core/fields.hpp"
#include "terrain/rigid/ground_profile.hpp"
#include "terrain/terrain_spec.hpp"

namespace furrow::terrain {

/// A stiff elastic layer: pressure = stiffness × depth + damping × its rate. The keys, and what the run supplies.
struct GroundOptions : TerrainContext {
  std::string scenario = "scenario";     // what messages name: the scenario's file
  double friction = 0.9;                 // -, at most the tire's
  double friction_velocity_scale = 5.0;  // c in F_t = μ N tanh(c |v_t|), s/m
  double ground_stiffness = 4e8;         // N/m³: 0.6 mm under 240 kPa; 4e5 N/m on a vertex that carries 10 cm²
  double ground_shear_stiffness = 1e8;   // N/m³: a tread of 1 MPa shear modulus, 10 mm thick
  double ground_damping = 2.5e4;         // N s/m³: holds such a vertex of 2.8 g on its own up to H = 4e-5 s
  ProfilePoints profile;                 // z at x; empty: the plane z = 0
  std::string profile_file;              // CSV or OpenCRG, in place of `profile`
  double profile_v = 0.0;                // of the cut of an OpenCRG file, m
  std::string road_class;                // of ISO 8608, A to H, in place of `profile`
  double road_from = 5.0;                // x where it begins, m
  double road_length = 100.0;            // m
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<GroundOptions> auto& s) {
  visit(Field{"friction", "-", role::key}, s.friction);
  visit(Field{"friction_velocity_scale", "s/m", role::key}, s.friction_velocity_scale);
  visit(Field{"ground_stiffness", "N/m³", role::key}, s.ground_stiffness);
  visit(Field{"ground_shear_stiffness", "N/m³", role::key}, s.ground_shear_stiffness);
  visit(Field{"ground_damping", "N s/m³", role::key}, s.ground_damping);
  visit(Field{"profile", "m", role::key}, s.profile);
  visit(Field{"profile_file", "", role::key}, s.profile_file);
  visit(Field{"profile_v", "m", role::key}, s.profile_v);
  visit(Field{"road_class", "", role::key}, s.road_class);
  visit(Field{"road_from", "m", role::key}, s.road_from);
  visit(Field{"road_length", "m", role::key}, s.road_length);
}

}  // namespace furrow::terrain
