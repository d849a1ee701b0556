// Hydrodynamic torque converter between an impeller and a turbine shaft; the stator's torque acts on their carriers.
// With the speed ratio R = u_t/u_i of a turning impeller:
//
//   0 ≤ R ≤ 1   T_i = (u_i/K(R))²,  T_t = T(R) T_i
//   R > 1       the turbine drives: T_i = −(u_t/K(1/R))², T_t = T_i, as a fluid coupling
//
// Rule at R = 1: K(1) is finite, so both branches end there in torques of opposite sign. Within 1 − w < R < 1 + w the
// impeller's torque is therefore a straight line in R on each side, from its value at R = 1 ∓ w (for the present u_i)
// to zero at R = 1; w = 0.02 by default. If T R ≤ 1 everywhere, the fluid only takes power.
//
// A turbine that turns forward drives an impeller that is at rest or turns backwards; otherwise this impeller is free.
#pragma once

#include <string>
#include <vector>

#include "vehicle/multibody/system.hpp"
#include "vehicle/multibody/table.hpp"

namespace furrow::vehicle {

struct ConverterOptions {
  Table capacity;       // K(R), (rad/s)/√(N m), 0 ≤ R ≤ 1
  Table torque_ratio;   // T(R)
  double blend = 0.02;  // w, 0 < w < 0.5
};

struct ConverterTorque {
  double impeller = 0.0;  // taken from the impeller, N m
  double turbine = 0.0;   // given to the turbine, N m
};

ConverterTorque converter_torque(const ConverterOptions& options, double impeller_speed, double turbine_speed);

class TorqueConverter {
 public:
  /// @throws Error(physics) for a capacity that is not positive or a blend out of range
  TorqueConverter(System& system, const std::string& name, int impeller, int turbine, const ConverterOptions& options);
  /// Energy taken by the fluid since the start, J.
  double heat(const System& system) const {
    return -system.rate_state(rows_[0]).work - system.rate_state(rows_[1]).work;
  }

 private:
  std::vector<int> rows_;
};

}  // namespace furrow::vehicle
