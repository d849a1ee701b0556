#include "tire/pressure_schedule.hpp"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "protocol/core/assert.hpp"

namespace furrow::tire {
namespace {
bool by_pressure(const PressureSchedule::Knot& a, const PressureSchedule::Knot& b) { return a.pressure < b.pressure; }
}  // namespace

double PressureSchedule::at(double time) const {
  FURROW_ASSERT(!knots.empty(), time);
  const auto after = std::find_if(knots.begin(), knots.end(), [&](const Knot& k) { return k.time > time; });
  if (after == knots.begin()) return knots.front().pressure;
  if (after == knots.end()) return knots.back().pressure;
  const Knot &a = *(after - 1), &b = *after;
  return a.pressure + (b.pressure - a.pressure) * ((time - a.time) / (b.time - a.time));
}

double PressureSchedule::lowest() const {
  FURROW_ASSERT(!knots.empty(), knots.size());
  return std::min_element(knots.begin(), knots.end(), by_pressure)->pressure;
}

double PressureSchedule::highest() const {
  FURROW_ASSERT(!knots.empty(), knots.size());
  return std::max_element(knots.begin(), knots.end(), by_pressure)->pressure;
}

void from_json(const nlohmann::json& value, PressureSchedule& schedule) {
  schedule.knots.clear();
  if (value.is_number()) {
    schedule.knots = {{0.0, value.get<double>()}};
    return;
  }
  for (const nlohmann::json& entry : value)
    schedule.knots.push_back({entry.at(0).get<double>(), entry.at(1).get<double>()});
}

}  // namespace furrow::tire
