// A brake or clutch: dry friction in a row in speeds. It holds the two sides together up to the torque of its capacity,
// and slips with this torque beyond. The law is set-valued: a holding coupling does not creep, for any step.
#pragma once

#include <string>

#include "vehicle/multibody/system.hpp"

namespace furrow::vehicle {

inline constexpr double kLockCreep = 1e-4;  // rad/s

class FrictionCoupling {
 public:
  /// A clutch between two shafts.
  static FrictionCoupling clutch(System& system, const std::string& name, int first, int second, double capacity);
  /// The lock of a differential: a clutch between its outputs that creeps in proportion to its torque, with kLockCreep
  /// at its capacity. The rows of a rigid lock and of brakes that hold both wheels would nearly depend on each other.
  static FrictionCoupling lock(System& system, const std::string& name, int first, int second, double capacity);
  /// A brake of body `b` against body `a`, about an axis fixed in b (W now). The torque acts on both.
  static FrictionCoupling brake(System& system, const std::string& name, int a, int b, const Vec3& axis,
                                double capacity);

  /// Sets the capacity to `share` of the whole from the next step on, 0 to 1. The system's saved state holds it.
  void engage(System& system, double share) const;
  bool holds(const System& system) const;     // engaged and not slipping
  double torque(const System& system) const;  // on the first shaft or on b, mean over the last step, N m
  double slip(const System& system) const;    // speed difference now, rad/s
  double heat(const System& system) const;    // energy dissipated since the start, J
  int row() const { return row_; }

 private:
  FrictionCoupling(System& system, const RateRow& row, double capacity);
  int row_ = 0;
  double capacity_ = 0.0;  // N m
};

}  // namespace furrow::vehicle
