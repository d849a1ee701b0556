// Inflation pressure as a function of time: straight lines between knots, constant before the first and after the
// last one.
#pragma once

#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace furrow::tire {

struct PressureSchedule {
  struct Knot {
    double time = 0.0;      // s
    double pressure = 0.0;  // gauge, Pa
    bool operator==(const Knot&) const = default;
  };
  std::vector<Knot> knots;  // times increase; empty: not stated

  bool empty() const { return knots.empty(); }
  bool varies() const { return knots.size() > 1; }
  double at(double time) const;  // Pa; @pre not empty, as for the next two
  double lowest() const;
  double highest() const;
  bool operator==(const PressureSchedule&) const = default;
};

/// Reads a number as one knot, or an array of [t, p] in s and Pa. Does not check them.
void from_json(const nlohmann::json& value, PressureSchedule& schedule);

}  // namespace furrow::tire
