// A small complete terrain, made by the recipe in CONTRIBUTING.md: the plane z = 0 on independent springs, without
// friction [Winkler 1867, Die Lehre von der Elasticität und Festigkeit].
//
// The force on a vertex with the area A at the height z is, if this is a push,
//   f = A (−κ z − d ż),                                                                                      (1)
// with the stiffness κ and the damping d per area, evaluated at the middle of each substep.
#pragma once

#include <memory>

#include <nlohmann/json_fwd.hpp>

#include "protocol/core/fields.hpp"
#include "protocol/core/key.hpp"
#include "protocol/files/read_context.hpp"
#include "terrain/terrain_spec.hpp"

namespace furrow::terrain {

/// The keys of the section `terrain` with engine spring_mat.
struct SpringMatOptions {
  double mat_stiffness = 1e7;  // κ, N/m³
  double mat_damping = 0.0;    // d, N s/m³
};
void visit_fields(FieldsOf<SpringMatOptions> auto& s, auto&& visit) {
  visit(s.mat_stiffness, key("mat_stiffness", "N/m³", allowed::above(0), "Stiffness of the mat per area."));
  visit(s.mat_damping, key("mat_damping", "N s/m³", allowed::from(0), "Damping of the mat per area."));
}

/// @pre the section was checked against the schema
std::unique_ptr<TerrainSpec> read_spring_mat(const nlohmann::json& section, const ReadContext& context);

}  // namespace furrow::terrain
