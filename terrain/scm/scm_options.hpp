// The keys of the section `terrain` with engine scm, empirical soil: each field is the key of its name.
#pragma once

#include <string>

#include "protocol/core/fields.hpp"
#include "protocol/core/key.hpp"
#include "terrain/rigid/ground_shape.hpp"
#include "terrain/terrain_keys.hpp"
#include "terrain/terrain_spec.hpp"

namespace furrow::terrain::scm {

/// The keys, and what the run supplies. The soil is by default the LETE sand of [Wong 2008].
/// How it springs back is not in that table: stiff enough to leave a rut, soft enough for the light vertices of a tire.
struct ScmOptions : TerrainContext {
  std::string scenario = "scenario";  // what messages name: the scenario's file
  std::string material;               // soil file whose values the other keys hold already; empty: none
  double cone_index = -1.0;           // Pa; negative: not known
  // Grid.
  double length = 10.0;        // x from 0 to length, m
  double width = 0.6;          // y from −width/2 to width/2, m
  double grid_spacing = 0.01;  // between nodes, m
  double patch_width = -1.0;   // b of Bekker's law, m; negative: found from each contact patch
  // Heights before the run.
  std::string profile_file;               // none: level, z = 0
  bool profile_across = true;             // heights of the file may change across
  std::string profile_line = "straight";  // how the reference line of OpenCRG lies
  double profile_v = 0.0;                 // of the file where y = 0, m
  double profile_from = -1.0;             // x where the file's first height lies, m; negative: where the file says
  GroundShape shape;                      // of the file
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
void visit_fields(FieldsOf<ScmOptions> auto& s, auto&& visit) {
  using namespace allowed;
  constexpr unsigned kSoil = role::key | role::soil;
  visit(s.material, keys::kMaterial);
  visit(s.cone_index, keys::kConeIndex);
  visit(s.length, keys::kLength);
  visit(s.width, keys::kWidth);
  visit(s.grid_spacing,
        key("grid_spacing", "m", above(0).to(10).usual(0.001, 0.1),
            "Distance between the nodes of the soil, engine scm. A contact patch should have ten nodes across."));
  visit(s.patch_width,
        key("patch_width", "m", above(0).to(1e4).usual(0.01, 2).or_null(),
            "Width b in (k_c/b + k_φ) zⁿ, engine scm. null: 2 × area/perimeter of each contact patch, which is the "
            "smaller side of a long patch and the radius of a round one."));
  visit(s.profile_file, keys::kProfileFile);
  visit(s.profile_across, keys::kProfileAcross);
  visit(s.profile_line, keys::kProfileLine);
  visit(s.profile_v, keys::kProfileV);
  visit(s.profile_from, keys::kProfileFrom);
  visit(s.bekker_k_c,
        key("bekker_k_c", "N/m^(n+1)", kSoil, from(-1e12, 1e12).usual(-1e6, 1e6),
            "Bekker's k_c in p = (k_c/b + k_φ) zⁿ, the pressure under a plate of width b at sinkage z, engine scm. It "
            "may be below 0."));
  visit(s.bekker_k_phi, key("bekker_k_phi", "N/m^(n+2)", kSoil, above(0).to(1e13).usual(1e4, 1e8),
                            "Bekker's k_φ in p = (k_c/b + k_φ) zⁿ, engine scm."));
  visit(s.bekker_n, key("bekker_n", "-", kSoil, above(0).to(5).usual(0.1, 2),
                        "Bekker's exponent n in p = (k_c/b + k_φ) zⁿ, engine scm."));
  visit(s.mohr_cohesion,
        key("mohr_cohesion", "Pa", kSoil, from(0, 1e9).usual(20, 1e5),
            "Cohesion c of soil mechanics in τ_max = c + p tan φ, engine scm. It is not the contact value `cohesion` "
            "of grains."));
  visit(s.mohr_friction_angle,
        key("mohr_friction_angle", "deg", kSoil, from(0, 80).usual(5, 50),
            "Friction angle φ in τ_max = c + p tan φ, engine scm. The tire's friction bounds τ_max too."));
  visit(s.janosi_k, key("janosi_k", "m", kSoil, above(0).to(10).usual(0.001, 0.1),
                        "Janosi's K in τ = τ_max (1 − exp(−j/K)), j the shear displacement, engine scm."));
  visit(
      s.unloading_stiffness,
      key("unloading_stiffness", "N/m³", kSoil, from(0, 1e15),
          "Stiffness k_0 in k_u = k_0 + A_u z, the pressure per rebound after unloading from sinkage z, engine scm."));
  visit(s.unloading_stiffness_rate,
        key("unloading_stiffness_rate", "N/m⁴", kSoil, from(0, 1e15),
            "Rate A_u in k_u = k_0 + A_u z, engine scm. k_u is never so small that the soil would rebound by more than "
            "it was pressed."));
  visit(
      s.rebound_damping,
      key("rebound_damping", "N s/m³", kSoil, from(0, 1e12),
          "Pressure per rate of sinkage while soil is unloaded and loaded again, engine scm. First loading has none."));
}

}  // namespace furrow::terrain::scm
