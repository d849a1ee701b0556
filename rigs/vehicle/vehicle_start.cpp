#include "rigs/vehicle/vehicle_start.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "protocol/core/archive.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"

namespace furrow::rigs {
namespace {

constexpr double kDeflection = 0.02;  // of the radius, in the trim
constexpr double kLeastLoad = 1e-3;   // of the mean load; a wheel must carry more

vehicle::TireCurve spring(double radius, double load) {
  const double stiffness = load / (kDeflection * radius);
  return {radius, [stiffness](double deflection) { return stiffness * std::max(0.0, deflection); }};
}

// The first trim uses springs for the mean load, the second a spring for each wheel's load in the first. Thus all tires
// have the same relative deflection, and the wheels' heights differ only by their radii.
vehicle::Trim stand_in(vehicle::Vehicle& vehicle, std::span<const double> radii, const Vec3& gravity) {
  const double weight = vehicle.mass() * std::abs(gravity.z()), mean = weight / static_cast<double>(radii.size());
  std::vector<vehicle::TireCurve> tires;
  for (const double radius : radii) tires.push_back(spring(radius, mean));
  const vehicle::Trim first = vehicle::trim(vehicle, tires, 0.0, gravity);
  for (std::size_t k = 0; k < radii.size(); ++k) {
    if (!(first.wheels[k].load > kLeastLoad * mean))
      throw physics_error(
          fmt::format("vehicle '{}': at rest the wheel {} carries {:.3g} N, expected a vehicle that "
                      "stands on all its wheels",
                      vehicle.spec().name, first.wheels[k].name, first.wheels[k].load));
    tires[k] = spring(radii[k], first.wheels[k].load);
  }
  return vehicle::trim(vehicle, tires, 0.0, gravity);
}

}  // namespace

vehicle::Trim stand(vehicle::Vehicle& vehicle, std::span<const double> radii, double heading) {
  FURROW_ASSERT(radii.size() == static_cast<std::size_t>(vehicle.wheel_count()), radii.size());
  const Vec3& gravity = vehicle.system().gravity();
  const vehicle::Trim level = stand_in(vehicle, radii, Vec3(0.0, 0.0, gravity.z()));
  if (gravity.x() == 0.0 && gravity.y() == 0.0) return level;
  Archive posture;
  vehicle.save(posture);
  try {
    return stand_in(vehicle, radii, Eigen::AngleAxisd(-heading, Vec3::UnitZ()) * gravity);
  } catch (const Error& error) {
    if (error.code() != ExitCode::physics) throw;
    vehicle.restore(posture);
    return level;
  }
}

}  // namespace furrow::rigs
