#include "vehicle/driveline/friction_coupling.hpp"

#include <cmath>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"

namespace furrow::vehicle {

FrictionCoupling::FrictionCoupling(System& system, const RateRow& row, double capacity) : capacity_(capacity) {
  if (!(capacity > 0.0) || !std::isfinite(capacity))
    throw physics_error("'" + row.name + "': its torque capacity must be positive");
  row_ = system.add_rate_row(row);
}

FrictionCoupling FrictionCoupling::clutch(System& system, const std::string& name, int first, int second,
                                          double capacity) {
  return {system, {name, {{first, 1.0}, {second, -1.0}}, {}}, capacity};
}

FrictionCoupling FrictionCoupling::lock(System& system, const std::string& name, int first, int second,
                                        double capacity) {
  return {system, {name, {{first, 1.0}, {second, -1.0}}, {}, kLockCreep / capacity}, capacity};
}

FrictionCoupling FrictionCoupling::brake(System& system, const std::string& name, int a, int b, const Vec3& axis,
                                         double capacity) {
  return {system, {name, {}, {{a, b, axis, 1.0}}}, capacity};
}

void FrictionCoupling::engage(System& system, double share) const {
  FURROW_ASSERT(share >= 0.0 && share <= 1.0, share);
  const double most = share * capacity_;
  system.set_rate_control(row_, {.mode = share > 0.0 ? RateMode::hold : RateMode::free, .lower = -most, .upper = most});
}

bool FrictionCoupling::holds(const System& system) const {
  return system.rate_control(row_).mode == RateMode::hold && system.rate_state(row_).side == 0;
}
double FrictionCoupling::torque(const System& system) const { return system.rate_state(row_).torque; }
double FrictionCoupling::slip(const System& system) const { return system.rate_speed(row_); }
double FrictionCoupling::heat(const System& system) const { return -system.rate_state(row_).work; }

}  // namespace furrow::vehicle
