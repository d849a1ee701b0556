// Actuators: a force or torque that a caller or a function prescribes, in a coordinate between two bodies. What acts on
// B acts on A with the opposite sign.
#pragma once

#include <functional>
#include <string>

#include "protocol/core/fields.hpp"
#include "vehicle/multibody/row.hpp"

namespace furrow::vehicle {

/// Force (N) or torque (N m) at a time (s); evaluated in the middle of each step.
using ActuatorLaw = std::function<double(double time)>;

struct ActuatorState {
  double command = 0.0;  // held until changed, N or N m; not used where there is a law
  double force = 0.0;    // mean over the last step, N or N m
  double work = 0.0;     // done on the bodies since the start, J
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<ActuatorState> auto& s) {
  visit(Field{"command", "N"}, s.command);
  visit(Field{"force", "N"}, s.force);
  visit(Field{"work", "J"}, s.work);
}

struct Actuator {
  std::string name;
  Row row;
  ActuatorLaw law;
  ActuatorState state;
  // Of the present half step.
  RowJacobian jacobian{};
  double impulse = 0.0, rate_before = 0.0;  // N s, m/s
};

}  // namespace furrow::vehicle
