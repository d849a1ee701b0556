// What `furrow press` measures: the static load–deflection curve of a tire and its footprint under a load.
#pragma once

#include <filesystem>

#include <nlohmann/json.hpp>

#include "protocol/core/progress_call.hpp"
#include "tire/ancf/press_solver.hpp"
#include "tire/tire_file.hpp"

namespace furrow::tire {

struct PressOptions {
  PressObstacle obstacle;
  double deflection = 0.02;  // largest, m
  int points = 10;           // of the curve up to it
  double load = 4561.65;     // of the footprint, N: 465 kg
  bool unload = true;        // the curve also back to zero
};

struct PressResults {
  std::vector<PressPoint> loading, unloading;
  PressPoint at_load;  // of the footprint; at the largest deflection when the load is not reached
  std::vector<PressSample> footprint;
  double inflation_growth = 0.0;  // of the largest radius, axisymmetric, m
  double pressure = 0.0;          // gauge, Pa
  MassProperties mass;            // of the whole tire about its centre
  double runout = 0.0;            // of the tire at rest before it is pressed: its wrinkles, m
};

/// What TireSpec::static_test() gives for models that can be pressed.
class StaticTest {
 public:
  virtual ~StaticTest() = default;
  /// @throws Error(physics) when there is no equilibrium
  virtual PressResults press(const PressOptions& options, const ProgressCall& progress) const = 0;
};

/// The static test of the shell. @pre points > 0, deflection > 0. @throws Error(physics) when there is no equilibrium
PressResults press_tire(const TireFile& file, const PressOptions& options, const ProgressCall& progress);

/// summary.json without what names the run.
nlohmann::ordered_json press_json(const PressOptions& options, const PressResults& results);

/// press.csv and footprint.csv. @throws Error(io)
void write_press_tables(const std::filesystem::path& folder, const PressResults& results);

}  // namespace furrow::tire
