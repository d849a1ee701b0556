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
  std::vector<Knot> knots;  // times increase; none: nothing is said

  bool empty() const { return knots.empty(); }
  bool varies() const { return knots.size() > 1; }
  double at(double time) const;  // Pa; @pre not empty, as for the next two
  double lowest() const;
  double highest() const;
  bool operator==(const PressureSchedule&) const = default;
};

/// A number is one knot, an array has [t, p] for each, in s and Pa; as read, not checked.
void from_json(const nlohmann::json& value, PressureSchedule& schedule);

}  // namespace furrow::tire
