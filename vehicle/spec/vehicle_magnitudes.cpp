#include "vehicle/spec/vehicle_magnitudes.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "protocol/core/assert.hpp"
#include "protocol/files/json_text.hpp"

namespace furrow::vehicle {
namespace {

constexpr double kLeastChassis = 0.05;  // of the mass of all other parts
constexpr double kLeastGyration = 0.05,
                 kMostGyration = 1.5;  // radius, of the largest distance between wheels

/// Largest distance between the centres of two wheels, m.
double size_of(const VehicleSpec& spec) {
  std::vector<Vec3> centers;
  for (const AxleSpec& axle : spec.axles)
    for (const CornerSpec& corner : axle.corners) centers.push_back(spindle_of(corner.suspension).center);
  double size = 0.0;
  for (const Vec3& a : centers)
    for (const Vec3& b : centers) size = std::max(size, (a - b).norm());
  return size;
}

}  // namespace

std::vector<std::pair<std::string, std::string>> unlikely_values(const VehicleSpec& spec, double mass) {
  FURROW_ASSERT(mass >= spec.chassis.mass, mass, spec.chassis.mass);
  const double others = mass - spec.chassis.mass;
  if (spec.chassis.mass < kLeastChassis * others)
    return {{"chassis.mass", fmt::format("is {} kg, all other parts have {:.4g} kg: another unit?",
                                         number_text(spec.chassis.mass), others)}};
  const double gyration = std::sqrt(0.5 * spec.chassis.inertia.trace() / spec.chassis.mass),
               size = size_of(spec);
  if (gyration < kLeastGyration * size || gyration > kMostGyration * size)
    return {{"chassis.inertia",
             fmt::format("gives a radius of gyration of {:.3g} m between wheels that are {:.3g} m "
                         "apart: another unit?",
                         gyration, size)}};
  return {};
}

}  // namespace furrow::vehicle
