#include "tire/pressure_text.hpp"

#include <fmt/format.h>

namespace furrow::tire {

std::string pressure_text(const PressureSchedule& p) {
  if (!p.varies()) return fmt::format("{:g} kPa", 1e-3 * p.at(0.0));
  return fmt::format("{:g} kPa, later {:g} to {:g} kPa", 1e-3 * p.at(0.0), 1e-3 * p.lowest(), 1e-3 * p.highest());
}

}  // namespace furrow::tire
