// A small complete tire model, made by the recipe in CONTRIBUTING.md: a rigid rim with radial springs to the vertices
// of its surface.
//
// A vertex has no mass, a stiffness k and a damping c. With f the force on it and e its radial direction, outwards, its
// deflection u, positive inwards, follows
//   c u̇ + k u = −f·e,                                                                                        (1)
// stepped by backward Euler. All forces pass to the rim, whose mass m and inertia J are the whole tire's:
//   F = Σ f + m g − Δ(m v)/H,   M = Σ (x − c) × f − Δ(J ω)/H.                                                (2)
#pragma once

#include <memory>

#include <nlohmann/json_fwd.hpp>

#include "protocol/core/fields.hpp"
#include "protocol/core/key.hpp"
#include "tire/tire_spec.hpp"

namespace furrow::tire {

/// The keys of a tire file with "model": "spring_wheel", in addition to the keys of all models.
struct SpringWheelOptions {
  static constexpr SchemaName kSchema{"spring_wheel", "A wheel of independent springs around a rigid rim."};
  double radius = 0.4;     // undeformed, m
  double width = 0.2;      // m
  int spokes = 36;         // pairs of vertices around the circumference
  double stiffness = 2e4;  // of one vertex, N/m
  double damping = 200.0;  // of one vertex, N s/m
  double mass = 30.0;      // kg, a solid cylinder's
};
void visit_fields(FieldsOf<SpringWheelOptions> auto& s, auto&& visit) {
  using namespace allowed;
  visit(s.radius, needed("radius", "m", from(0.01), "Undeformed radius."));
  visit(s.width, needed("width", "m", from(0.01), "Width."));
  visit(s.spokes, needed("spokes", "", from(3), "Pairs of vertices around the circumference."));
  visit(s.stiffness, needed("stiffness", "N/m", from(1), "Stiffness of one vertex."));
  visit(s.damping, needed("damping", "N s/m", from(0), "Damping of one vertex."));
  visit(s.mass, needed("mass", "kg", from(0.01), "Mass, a solid cylinder's."));
}

/// @throws Error(bad_input) naming file and key
std::unique_ptr<TireSpec> read_spring_wheel(const nlohmann::json& file, const TireOptions& options);

}  // namespace furrow::tire
