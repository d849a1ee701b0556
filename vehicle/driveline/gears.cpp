#include "vehicle/driveline/gears.hpp"

#include <cmath>

#include "protocol/core/error.hpp"

namespace furrow::vehicle {
int add_gear(System& system, const std::string& name, int in, int out, double ratio) {
  if (ratio == 0.0 || !std::isfinite(ratio)) throw physics_error("gear '" + name + "': its ratio must not be zero");
  return system.add_rate_row({name, {{out, 1.0}, {in, -ratio}}, {}}, {.mode = RateMode::hold});
}

int add_differential(System& system, const std::string& name, int box, int first, int second, double share) {
  if (!(share > 0.0 && share < 1.0))
    throw physics_error("differential '" + name + "': its share of torque must lie between 0 and 1");
  return system.add_rate_row({name, {{first, share}, {second, 1.0 - share}, {box, -1.0}}, {}},
                             {.mode = RateMode::hold});
}

int add_shaft_to_body(System& system, const std::string& name, int shaft, int body, const Vec3& axis) {
  RateRow row{name, {{shaft, -1.0}}, {{system.shaft(shaft).carrier, body, axis, 1.0}}};
  return system.add_rate_row(row, {.mode = RateMode::hold});
}

}  // namespace furrow::vehicle
