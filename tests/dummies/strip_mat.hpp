// A small terrain of several ranks, for tests: a mat of columns side by side along the travel, each w wide in x and as
// wide as the bin in y. It has no friction. The force on a tire's vertex with the area A at the height z above column i
// is, if this is a push,
//   f = A (κ (h_i − z) − d ż).                                                                               (1)
// In every substep of Δt the columns yield and level out,
//   h_i ← h_i − Δt/T Σ f / (κ w b),    h_i ← h_i + γ (h_{i−1} − 2 h_i + h_{i+1}),                            (2)
// with the width b of the bin. Each rank computes its own columns and receives those of the other ranks in every
// substep. The results have the same bits for any number of ranks.
#pragma once

#include <memory>

#include <nlohmann/json_fwd.hpp>

#include "protocol/core/fields.hpp"
#include "protocol/files/read_context.hpp"
#include "terrain/terrain_spec.hpp"

namespace furrow::terrain {

/// The keys of the section `terrain` with engine strip_mat.
struct StripMatOptions {
  double length = 10.0, width = 0.6;  // of the bin, m
  double stiffness = 4e8;             // κ, N/m³
  double damping = 2.5e4;             // d, N s/m³
};
void visit_fields(FieldsOf<StripMatOptions> auto& s, auto&& visit) {
  visit(s.length, Field{"length", "m", role::key});
  visit(s.width, Field{"width", "m", role::key});
  visit(s.stiffness, Field{"ground_stiffness", "N/m³", role::key});
  visit(s.damping, Field{"ground_damping", "N s/m³", role::key});
}

/// @pre the section was checked against the schema
std::unique_ptr<TerrainSpec> read_strip_mat(const nlohmann::json& section, const ReadContext& context);

}  // namespace furrow::terrain
