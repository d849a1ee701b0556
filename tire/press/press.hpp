// Results of `furrow press`: the static load–deflection curve of a tire and its footprint under a load.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "protocol/core/progress_call.hpp"
#include "protocol/core/surface.hpp"
#include "tire/press/press_obstacle.hpp"

namespace furrow::tire {

struct PressOptions {
  PressObstacle obstacle;
  double deflection = 0.02;  // largest, m
  int points = 10;           // of the curve up to it
  /// Deflections of the curve instead of equal steps, increasing, m: `points` of them, the last is `deflection`.
  std::vector<double> at = {};
  double load = 4561.65;  // of the footprint, N: 465 kg
  bool unload = true;     // whether the curve also returns to zero
  bool partial = false;   // whether a curve that ends early is a result, with PressResults::ended
  std::string deflection_from = "command line", deflection_key = "--deflection";  // for messages
  std::string camber_from = "command line", camber_key = "--camber";
};

struct PressResults {
  std::vector<PressPoint> loading, unloading;
  PressPoint at_load;  // point of the footprint; at the largest deflection if the load is not reached
  std::vector<PressSample> footprint;
  std::optional<GroundStiffness> stiffness;  // at the footprint's load
  std::string stiffness_missing;             // why parts of it are NaN; empty: none is
  double start_height = 0.0;                 // of the rim's centre over the obstacle's top where deflection starts, m
  std::string base_missed;                   // what the model leaves out beyond a cleat's height; empty: nothing
  std::string ended;                         // why the curve ends early; empty if it does not
  std::optional<double> inflation_growth;    // of the largest radius, axisymmetric, m; if the model has one
  std::optional<double> footprint_width;     // m; if the model has no points across
  std::optional<double> pressure;            // gauge, Pa; if the model has one
  MassProperties mass;                       // of the whole tire about its centre
  double runout = 0.0;                       // of radius, of the unpressed tire: height of its wrinkles, m
  double director_runout = 0.0;              // of the angle between directors and axle, of the unpressed tire, rad
};

/// Measures the curve, loading and unloading, and the footprint under the load, with any model.
struct PressModel {
  std::function<PressPoint(double deflection)> press;   // throws Error(physics) without an equilibrium
  std::function<std::vector<PressSample>()> footprint;  // of the last point
  std::function<GroundStiffness()> stiffness;           // of the last point
  std::function<void()> unpressed = {};                 // called after the first point
};
/// @param share called with the share of the curve that is done
/// @throws Error(physics) if an equilibrium is not found, unless the results may be partial and have a load
void measure_press(const PressOptions& options, const PressModel& model, const std::function<void(double share)>& share,
                   PressResults& results);

/// Why a model whose section does not change across its width has neither a lateral nor a torsional stiffness.
inline constexpr const char* kAlikeAcross =
    "lateral and torsional: the model is alike across its width and rigid sideways";
/// @throws Error(bad_input) if camber is asked for; for models whose section does not change across their width
void require_no_camber(const PressOptions& options, const char* name);

/// What a model of a bar without its base leaves out in this test, in words; empty: nothing.
std::string base_missed(const PressOptions& options, const char* name);

/// Static test of a model that can be pressed, as TireSpec::static_test() makes it.
class StaticTest {
 public:
  virtual ~StaticTest() = default;
  /// @throws Error(physics) when there is no equilibrium
  virtual PressResults press(const PressOptions& options, const ProgressCall& progress) const = 0;
};

/// A static test whose results are call(options, progress).
template <class Call>
std::unique_ptr<StaticTest> static_test_of(Call call) {
  struct Called final : StaticTest {
    explicit Called(Call c) : call(std::move(c)) {}
    PressResults press(const PressOptions& options, const ProgressCall& progress) const override {
      return call(options, progress);
    }
    Call call;
  };
  return std::make_unique<Called>(std::move(call));
}

/// Text of a warning about the curve's equilibria; empty: no warning.
std::string press_caution(const PressResults& results);

/// summary.json without the keys that identify the run.
nlohmann::ordered_json press_json(const PressOptions& options, const PressResults& results);

/// Writes press.csv and footprint.csv. @throws Error(io)
void write_press_tables(const std::filesystem::path& folder, const PressResults& results);

}  // namespace furrow::tire
