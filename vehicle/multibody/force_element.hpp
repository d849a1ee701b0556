// Springs, dampers and similar elements: a scalar force law in one coordinate between two bodies.
#pragma once

#include <functional>
#include <string>

#include "protocol/core/fields.hpp"
#include "vehicle/multibody/row.hpp"

namespace furrow::vehicle {

/// Force in the coordinate (positive pushes the points apart, or B along the axis, or turns B positively), N or N m,
/// and its damping −∂f/∂rate ≥ 0, N s/m or N m s. A law whose energies are tracked also gives the part of the force
/// that is the negative slope of an energy, and this energy (J).
struct ElementForce {
  double force = 0.0;
  double damping = 0.0;
  double elastic = 0.0;
  double energy = 0.0;
};

/// f(value, rate, time): value in m or rad, rate in m/s or rad/s.
using ForceLaw = std::function<ElementForce(double value, double rate, double time)>;

/// f = −k (x − x₀) − c ẋ; k in N/m, c in N s/m (or the angular counterparts).
inline ForceLaw linear_spring_damper(double k, double rest, double c) {
  return [=](double value, double rate, double) { return ElementForce{-k * (value - rest) - c * rate, c}; };
}

struct ForceElement {
  std::string name;
  Row row;
  ForceLaw law;
  double last_force = 0.0;  // mean over the last step, N or N m
};

/// Energies of a force element (System::track_energy).
struct ElementEnergy {
  double stored = 0.0;      // of the elastic part now, J
  double elastic = 0.0;     // work done by the elastic part since the start, J
  double dissipated = 0.0;  // energy taken by the other part since the start, J
};
void visit_fields(FieldsOf<ElementEnergy> auto& s, auto&& visit) {
  visit(s.stored, Field{"stored", "J"});
  visit(s.elastic, Field{"elastic", "J"});
  visit(s.dissipated, Field{"dissipated", "J"});
}

}  // namespace furrow::vehicle
