// How large the tires of a scenario are and where their axles travel, before any model is made.
#pragma once

#include "nodes/scenario/scenario.hpp"
#include "tire/tire_file.hpp"

namespace furrow::scenario {

/// What the checks need to know of a tire without building its model.
struct TireSize {
  double radius = 0.0;  // undeformed, m
  double width = 0.0;   // overall, m
  tire::PressureSchedule pressure;
  int elements_circumference = 0, elements_width = 0;
  bool rigid = false;
  /// Unknowns: position and transverse gradient of every node; 0 for a rigid tire.
  int coordinates() const { return rigid ? 0 : 6 * elements_circumference * (elements_width + 1); }
  int vertices() const { return elements_circumference * (elements_width + 1); }
};

/// @throws Error(bad_input) naming file and key
TireSize tire_size(const tire::TireOptions& options);
/// The same for a file that was read already.
TireSize tire_size(const tire::TireOptions& options, tire::TireFile file);

/// From start to end of the run, m.
struct AxlePath {
  double from = 0.0, to = 0.0;
};
AxlePath axle_path(const Scenario& scenario, std::size_t wheel, double tire_radius);

}  // namespace furrow::scenario
