#include "vehicle/driveline/torque_converter.hpp"

#include <algorithm>
#include <cmath>

#include "protocol/core/error.hpp"

namespace furrow::vehicle {
namespace {

ConverterTorque driving(const ConverterOptions& o, double impeller_speed, double ratio) {
  const double root = impeller_speed / o.capacity.value(std::max(0.0, ratio));
  return {root * root, o.torque_ratio.value(std::max(0.0, ratio)) * root * root};
}

ConverterTorque overrunning(const ConverterOptions& o, double turbine_speed, double inverse_ratio) {
  const double root = turbine_speed / o.capacity.value(std::max(0.0, inverse_ratio));
  return {-root * root, -root * root};
}

}  // namespace

ConverterTorque converter_torque(const ConverterOptions& o, double u_i, double u_t) {
  if (u_i <= 0.0) return u_t > 0.0 ? overrunning(o, u_t, 0.0) : ConverterTorque{};
  const double ratio = u_t / u_i, w = o.blend;
  if (ratio <= 1.0 - w) return driving(o, u_i, ratio);
  if (ratio >= 1.0 + w) return overrunning(o, u_t, 1.0 / ratio);
  if (ratio >= 1.0) {
    const double torque = (ratio - 1.0) / w * overrunning(o, (1.0 + w) * u_i, 1.0 / (1.0 + w)).impeller;
    return {torque, torque};
  }
  const double torque = (1.0 - ratio) / w * driving(o, u_i, 1.0 - w).impeller;
  return {torque, o.torque_ratio.value(ratio) * torque};
}

TorqueConverter::TorqueConverter(System& system, const std::string& name, int impeller, int turbine,
                                 const ConverterOptions& options) {
  if (!(options.blend > 0.0 && options.blend < 0.5))
    throw physics_error("converter '" + name + "': its blend must lie between 0 and 0.5");
  for (int k = 0; k <= 100; ++k)
    if (!(options.capacity.value(0.01 * k) > 0.0))
      throw physics_error("converter '" + name + "': its capacity must be positive from speed ratio 0 to 1");
  rows_ = system.add_rate_law(
      {RateRow{name + " impeller", {{impeller, 1.0}}, {}}, RateRow{name + " turbine", {{turbine, 1.0}}, {}}},
      [o = options](std::span<const double> u, double, std::span<ElementForce> torques) {
        const ConverterTorque torque = converter_torque(o, u[0], u[1]);
        torques[0] = {-torque.impeller, 0.0};
        torques[1] = {torque.turbine, 0.0};
      });
}

}  // namespace furrow::vehicle
