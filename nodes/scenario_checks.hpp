// What a schema cannot say: how the values of a scenario must fit each other, its files and this machine.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "nodes/scenario.hpp"

namespace furrow {

/// What the checks need to know of a tire without building its model.
struct TireSize {
  double radius = 0.0;  // undeformed, m
  double width = 0.0;   // overall, m
  PressureSchedule pressure;
  int elements_circumference = 0, elements_width = 0;
  bool rigid = false;
  /// Unknowns: position and transverse gradient of every node; 0 for a rigid tire.
  int coordinates() const { return rigid ? 0 : 6 * elements_circumference * (elements_width + 1); }
  int vertices() const { return elements_circumference * (elements_width + 1); }
};

/// @throws Error(bad_input) naming file and key
TireSize tire_size(const TireOptions& options);

/// `name` as it stands, relative to the scenario's folder, or in the data folders rigs/ and tire/data/.
/// @throws Error(bad_input) naming the key and where it was looked for
std::filesystem::path find_file(const std::string& name, const std::string& key,
                                const std::filesystem::path& scenario);

/// From start to end of the run, m.
struct AxlePath {
  double from = 0.0, to = 0.0;
};
AxlePath axle_path(const Scenario& scenario, std::size_t wheel, double tire_radius);

/// Distance that a tire keeps from a wall by default: room for what it bulges, m.
inline constexpr double kWallMargin = 0.02;

/// Fills scenario.rigs[k].start if `default_start[k]`, checks all, and adds warnings.
/// @throws Error(bad_input)
void check_scenario(Scenario& scenario, const std::vector<bool>& default_start);

}  // namespace furrow
