#include "nodes/scenario/wheel_geometry.hpp"

#include "protocol/core/assert.hpp"
#include "tire/read_tire_file.hpp"

#include <algorithm>
#include <cmath>

namespace furrow::scenario {

TireSize tire_size(const tire::TireOptions& options, tire::TireFile file) {
  if (options.elements_circumference > 0) file.elements_circumference = options.elements_circumference;
  if (options.elements_width > 0) tire::set_elements_width(file, options.elements_width);
  TireSize size;
  size.radius = file.radius;
  for (const tire::ProfileKnot& knot : file.profile)
    size.width = std::max(size.width, 2.0 * std::abs(knot.y));
  size.pressure = options.pressure;
  if (size.pressure.empty()) size.pressure.knots = {{0.0, file.pressure}};
  size.elements_circumference = file.elements_circumference;
  size.elements_width = file.elements_width();
  size.rigid = options.rigid;
  return size;
}

TireSize tire_size(const tire::TireOptions& options) {
  return tire_size(options, tire::read_tire_file(options.file));
}

AxlePath axle_path(const Scenario& scenario, std::size_t wheel, double tire_radius) {
  FURROW_ASSERT(in_range(wheel, scenario.rigs.size()), wheel, scenario.rigs.size());
  FURROW_ASSERT(tire_radius > 0.0, tire_radius);
  const rigs::DrawbarRigOptions& rig = scenario.rigs[wheel];
  const double speed =
      rig.mode == "fixed_angular_speed" ? rig.angular_speed * tire_radius * (1.0 - rig.slip) : rig.speed;
  // Over the ramp the mean speed is half of the full one.
  const double ramped = std::min(rig.ramp, scenario.run.end);
  const double travel = speed * (scenario.run.end - 0.5 * ramped);
  return {rig.start, rig.start + rig.travel_sign * travel};
}

}  // namespace furrow::scenario
