// The keys of the section `terrain` with engine scm, empirical soil: each field is the key of its name.
#pragma once

#include <string>

#include "protocol/core/fields.hpp"
#include "terrain/terrain_spec.hpp"

namespace furrow::terrain::scm {

/// The keys, and what the run supplies. The soil is by default the LETE sand of [Wong 2008].
/// How it springs back is not in that table: stiff enough to leave a rut, soft enough for the light vertices of a tire.
struct ScmOptions : TerrainContext {
  std::string scenario = "scenario";  // what messages name: the scenario's file
  std::string material;               // soil file whose values the other keys hold already; empty: none
  // Grid.
  double length = 10.0;        // x from 0 to length, m
  double width = 0.6;          // y from −width/2 to width/2, m
  double grid_spacing = 0.01;  // between nodes, m
  double patch_width = -1.0;   // b of Bekker's law, m; negative: found from each contact patch
  // Soil.
  double bekker_k_c = 102e3;              // N/m^(n+1)
  double bekker_k_phi = 5301e3;           // N/m^(n+2)
  double bekker_n = 0.79;                 // -
  double mohr_cohesion = 1300.0;          // c, Pa
  double mohr_friction_angle = 31.1;      // φ, degrees
  double janosi_k = 0.012;                // K, m
  double unloading_stiffness = 1e8;       // k_0, N/m³: 2 mm back from 200 kPa
  double unloading_stiffness_rate = 0.0;  // A_u, N/m⁴
  double rebound_damping = 1e4;           // N s/m³, below the yield pressure only
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<ScmOptions> auto& s) {
  constexpr unsigned kSoil = role::key | role::soil;
  visit(Field{"material", "", role::key}, s.material);
  visit(Field{"length", "m", role::key}, s.length);
  visit(Field{"width", "m", role::key}, s.width);
  visit(Field{"grid_spacing", "m", role::key}, s.grid_spacing);
  visit(Field{"patch_width", "m", role::key}, s.patch_width);
  visit(Field{"bekker_k_c", "N/m^(n+1)", kSoil}, s.bekker_k_c);
  visit(Field{"bekker_k_phi", "N/m^(n+2)", kSoil}, s.bekker_k_phi);
  visit(Field{"bekker_n", "-", kSoil}, s.bekker_n);
  visit(Field{"mohr_cohesion", "Pa", kSoil}, s.mohr_cohesion);
  visit(Field{"mohr_friction_angle", "deg", kSoil}, s.mohr_friction_angle);
  visit(Field{"janosi_k", "m", kSoil}, s.janosi_k);
  visit(Field{"unloading_stiffness", "N/m³", kSoil}, s.unloading_stiffness);
  visit(Field{"unloading_stiffness_rate", "N/m⁴", kSoil}, s.unloading_stiffness_rate);
  visit(Field{"rebound_damping", "N s/m³", kSoil}, s.rebound_damping);
}

}  // namespace furrow::terrain::scm
