#include "vehicle/spec/shaft_speeds.hpp"

#include <string>

#include "protocol/core/assert.hpp"

namespace furrow::vehicle {

std::vector<double> shaft_speeds(const DrivelineSpec& line, std::size_t gear) {
  FURROW_ASSERT(line.engine.has_value() && (!line.gearbox || gear < line.gearbox->ratios.size()), gear);
  std::vector<double> speed(line.shafts.size(), 0.0);
  const auto join = [&](const std::string& in, const std::string& out, double ratio) {
    double &a = speed[line.shaft(in)], &b = speed[line.shaft(out)];
    if (a != 0.0 && b == 0.0) b = ratio * a;
    if (b != 0.0 && a == 0.0) a = b / ratio;
  };
  speed[line.shaft(line.engine->shaft)] = 1.0;
  for (std::size_t round = 0; round < line.shafts.size(); ++round) {
    if (line.converter) join(line.converter->in, line.converter->out, 1.0);
    if (line.clutch) join(line.clutch->in, line.clutch->out, 1.0);
    if (line.gearbox) join(line.gearbox->in, line.gearbox->out, line.gearbox->ratios[gear]);
    for (const GearSpec& one : line.gears) join(one.in, one.out, one.ratio);
    for (const DifferentialSpec& d : line.differentials)
      for (const std::string& output : d.outputs) join(d.box, output, 1.0);
  }
  return speed;
}

}  // namespace furrow::vehicle
