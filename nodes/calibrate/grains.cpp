// The kind of calibration that fits grains to the strength of a soil: it compares the results of the virtual soil tests
// (terrain/soil) with measurements on the soil.
//
//   "start": "drawbar_pull_small.json", "set": {"terrain.material": "loose_sand.json"},   a scenario with grains
//   "tests": {"seeds": 2, "stresses": [5e3, 15e3, 40e3], "speed": 0.1},
//   "targets": [{"quantity": "friction_angle_deg", "data": "lete_sand.json", "sigma": 1.0},     value of a soil file
//               {"quantity": "bulk_density_kg_m3", "value": 1500, "sigma": 30},
//               {"data": "plate_60mm.csv", "disc": 0.06, "depth": 0.15, "relative_sigma": 0.1}]    p(z) of a plate
//
// Parameters are keys of the section `terrain`, quantities are figures of soil.json. A prediction is the result of
// `furrow soil` for the start with the parameters as settings, to the last bit, with its standard errors between beds.
// Only the tests that the targets need are run. Results for held-out targets are kept with the fitted ones of the same
// parameters.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "nodes/calibrate/kinds.hpp"
#include "nodes/calibrate/optimum.hpp"
#include "nodes/scenario/load_scenario.hpp"
#include "nodes/scenario/soil_material.hpp"
#include "nodes/study/study.hpp"
#include "protocol/core/clock.hpp"
#include "protocol/core/constants.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/csv_file.hpp"
#include "protocol/files/data_files.hpp"
#include "protocol/files/fields_json.hpp"
#include "protocol/files/json_text.hpp"
#include "terrain/soil/soil_tests.hpp"

namespace furrow::calibrate {
namespace {

using scenario::Settings;
using terrain::dem::DemOptions;
using terrain::soil::Measured, terrain::soil::SoilOptions, terrain::soil::SoilParameters, terrain::soil::SoilResults;

/// Lower limit of the shear cell's K, in diameters of a grain; all soils of scripts/docs/soils.md are above it (0.5 to
/// 1.2).
constexpr double kLeastK = 0.45;
constexpr int kMostSeeds = 100;
constexpr double kMostSpeed = 10.0;  // m/s, as of `furrow soil`
constexpr double kMostStress = 1e7;  // Pa, as of `furrow soil`
constexpr std::size_t kMostStresses = 10;
constexpr int kMostPoints = 20;  // of a curve
constexpr int kUsualPoints = 5;
constexpr double kUsualRelativeSigma = 0.1;
constexpr double kMostSize = 10.0;   // m, as of `furrow soil`
constexpr double kLoose = 0.4;       // solid fraction: loosest soil above a plate
constexpr double kLeastReach = 1.2;  // of a curve over the first sinkage that counts
constexpr double kOneBed = 0.1;      // of a bed, relative
constexpr double kSame = 1e-9;       // m: sizes and depths that differ by no more are equal
constexpr double kWindow = 0.25;     // diameters of a grain on either side of a point at which a curve is read

const auto kGrainRules = std::to_array<ParameterRule>({
    {"friction", "-", 0.0, 10.0, 0.2, 1.0, false},
    {"rolling_friction", "-", 0.0, 10.0, 0.0, 0.8, false},
    {"cohesion", "Pa", 0.0, 1e9, 0.0, 60e3, false},
    {"radius", "m", 1e-4, 0.1, 4e-3, 0.012, true},
    {"size_spread", "-", 0.0, 0.6, 0.0, 0.4, false},
    {"solid_fraction", "-", 0.3, 0.74, 0.52, 0.62, false},
    {"settling_friction", "-", 0.0, 10.0, 0.0, 0.5, false},
    {"compaction_pressure", "Pa", 0.0, 1e7, 0.0, 50e3, false},
    {"density", "kg/m³", 100.0, 2e4, 2000.0, 3000.0, false},
    {"young_modulus", "Pa", 1e5, 1e11, 1e7, 1e8, true},
    {"bulk_density", "kg/m³", 50.0, 2e4, 1200.0, 1800.0, false},
});

// ---- curves of plates

/// Range in which a curve is read.
struct Window {
  double from = 0.0, to = 0.0;  // m
};

/// Mean of p(z) over the window, up to the curve's end. @pre rising z, two points or more
double pressure_in(Window window, std::span<const double> sinkage, std::span<const double> pressure) {
  const double from = std::max(window.from, sinkage.front()), to = std::min(window.to, sinkage.back());
  double area = 0.0;
  for (std::size_t k = 1; k < sinkage.size(); ++k) {
    const double a = std::max(sinkage[k - 1], from), b = std::min(sinkage[k], to), step = sinkage[k] - sinkage[k - 1];
    if (a >= b) continue;
    const double middle = (0.5 * (a + b) - sinkage[k - 1]) / step;
    area += (b - a) * (pressure[k - 1] + middle * (pressure[k] - pressure[k - 1]));
  }
  return area / (to - from);
}

/// A plate on a bed, and the points at which its curve is compared.
struct PlateTarget {
  bool disc = false;
  double size = 0.0, depth = 0.0;  // m
  std::vector<double> sinkage;     // rising, m
  std::vector<Window> windows;     // about the sinkages, up to the measured curve's end
};

// ---- results of the tests

/// A figure of soil.json, and the key of soil files that gives it to the engine scm.
struct Quantity {
  std::string_view name, of_file;
  bool SoilOptions::*test;             // the test that measures it; null: any
  Measured SoilParameters::*measured;  // null: the bulk density of the beds
  double unit;                         // of the name, in SI units
  double least, most;                  // of a target, in the unit of its name
};
constexpr auto kQuantities = std::to_array<Quantity>({
    {"friction_angle_deg", "mohr_friction_angle", &SoilOptions::shear, &SoilParameters::phi, kDegree, 0.0, 60.0},
    {"cohesion_Pa", "mohr_cohesion", &SoilOptions::shear, &SoilParameters::cohesion, 1.0, 0.0, 1e7},
    {"friction_angle_without_cohesion_deg", "", &SoilOptions::shear, &SoilParameters::phi_alone, kDegree, 0.0, 85.0},
    {"janosi_K_m", "janosi_k", &SoilOptions::shear, &SoilParameters::K, 1.0, 1e-6, 1.0},
    {"repose_angle_deg", "", &SoilOptions::repose, &SoilParameters::repose, kDegree, 0.0, 85.0},
    {"repose_angle_without_cohesion_deg", "", &SoilOptions::repose, &SoilParameters::repose_dry, kDegree, 0.0, 60.0},
    {"n", "bekker_n", &SoilOptions::plate, &SoilParameters::n, 1.0, 1e-3, 5.0},
    {"k_c", "bekker_k_c", &SoilOptions::plate, &SoilParameters::k_c, 1.0, -1e12, 1e12},
    {"k_phi", "bekker_k_phi", &SoilOptions::plate, &SoilParameters::k_phi, 1.0, 0.0, 1e13},
    {"cone_index_Pa", "", &SoilOptions::cone, &SoilParameters::cone_index, 1.0, 0.0, 1e9},
    {"bulk_density_kg_m3", "", nullptr, nullptr, 1.0, 50.0, 2e4},
});

/// Bulk density of the beds of the first test that was made, in the order of their cost.
Measured bulk_density(const SoilResults& results) {
  std::vector<double> beds;
  const auto take = [&](const auto& tests) {
    if (!beds.empty()) return;
    for (std::size_t k = 0; k < tests.size(); ++k)  // several tests share one bed
      if (k == 0 || tests[k].specimen.seed != tests[k - 1].specimen.seed)
        beds.push_back(tests[k].specimen.bulk_density);
  };
  take(results.shear), take(results.repose);
  for (const auto& tests : results.plate) take(tests);
  take(results.cone);
  return terrain::soil::mean_of(beds);
}

// ---- the model

struct TestSettings {
  int seeds = 3;
  double speed = 0.1;            // m/s
  std::vector<double> stresses;  // Pa; empty: those of `furrow soil`
};

TestSettings read_tests(OrderedJsonReader& whole) {
  TestSettings tests;
  if (!takes(whole, "tests")) return tests;
  OrderedJsonReader reader = whole.child("tests");
  if (takes(reader, "seeds")) tests.seeds = reader.count("seeds", 1, kMostSeeds);
  if (takes(reader, "speed")) tests.speed = reader.positive("speed");
  if (tests.speed > kMostSpeed)
    reader.fail("speed", "is {} m/s, expected above 0 up to {:g} m/s", number_text(tests.speed), kMostSpeed);
  if (takes(reader, "stresses")) {
    std::vector<double>& stresses = tests.stresses = reader.numbers("stresses");
    std::sort(stresses.begin(), stresses.end());
    const bool differ = std::adjacent_find(stresses.begin(), stresses.end()) == stresses.end();
    if (stresses.size() < 2 || stresses.size() > kMostStresses || !differ)
      reader.fail("stresses", "expected two to {} different normal stresses, Pa: c and φ are of a line through them",
                  kMostStresses);
    const double odd = stresses.front() > 0.0 ? stresses.back() : stresses.front();
    if (!(odd > 0.0 && odd <= kMostStress))
      reader.fail("stresses", "has {} Pa, expected each above 0 up to {} Pa", number_text(odd),
                  number_text(kMostStress));
  }
  reader.finish();
  return tests;
}

class GrainModel final : public CalibrationModel {
 public:
  explicit GrainModel(CalibrationInput& input) : CalibrationModel(input) {
    set_ = study::settings_of(input.whole.object_or_empty("set"));
    tests_ = read_tests(input.whole);
    try {
      const scenario::Scenario scenario = scenario::load_scenario(start_, set_, scenario::Purpose::soil_tests);
      grains_ = scenario.grains("only grains can be tested");
      state_ = scenario.digest;
    } catch (const Error& error) {
      if (set_.empty()) throw;
      throw Error(error.code(), fmt::format("{}\n{}: with its key 'set'", error.what(), input.study.string()));
    }
    for (const auto& [key, value] : set_)
      if (key.starts_with("terrain.") && fits(key.substr(8)))
        throw input_error(input.study.string(), "set." + key, "is a parameter too, expected its 'start' there");
    state_ += fmt::format(" {} {:.17g} {}", tests_.seeds, tests_.speed, fmt::join(tests_.stresses, " "));
    for (const TargetSet set : kBothSets)
      for (OrderedJsonReader& reader : input.targets[set]) {
        if (reader.has("disc") || reader.has("strip"))
          read_curve(reader, input.study, set);
        else if (reader.has("quantity"))
          read(reader, input.study, set);
        else
          reader.fail("quantity", "is missing, expected it, or for a plate's curve 'disc' or 'strip' with its size, m");
      }
    leave_out_small_K(input);
  }

  std::vector<double> start_values() const override {
    std::vector<double> values;
    for (const std::string& name : names_) {
      const double value = *number_named(grains_, name);
      values.push_back(value < 0.0 ? NAN : value);  // null
    }
    return values;
  }

  Prediction predict(std::span<const double> values, TargetSet set, const ProgressCall& progress) override {
    const std::vector<double> key(values.begin(), values.end());
    auto known = known_.find(key);
    if (known == known_.end()) known = known_.emplace(key, tested(values, progress)).first;
    const Prediction& found = known->second;
    if (!found.problem.empty()) return found;
    // All figures are kept; the prediction has those of the set.
    Prediction part;
    part.processor_time = set == TargetSet::fitted ? found.processor_time : 0.0;
    for (const Measures& target : measures_[set])
      for (std::size_t k = 0; k < target.count; ++k)
        part.values.push_back(found.values[target.first + k]), part.errors.push_back(found.errors[target.first + k]);
    return part;
  }

  nlohmann::ordered_json fitted_file(std::span<const double> values, const std::string& source) const override {
    const DemOptions grains = grains_of(values);
    nlohmann::ordered_json file{{"format_version", 1}, {"description", source}};
    file["terrain"] = fields_json(grains, role::soil);
    file["measured"] = {{"grain_radius_m", grains.radius}, {"seeds", tests_.seeds}};
    return file;
  }

 private:
  Settings settings(std::span<const double> values) const {
    Settings all = set_;
    for (std::size_t k = 0; k < names_.size(); ++k)
      all.emplace_back("terrain." + names_[k], fmt::format("{:.17g}", values[k]));
    return all;
  }
  DemOptions grains_of(std::span<const double> values) const {
    return scenario::load_scenario(start_, settings(values), scenario::Purpose::soil_tests)
        .grains("only grains can be tested");
  }

  /// Object of a target's comparison: a quantity, or the points of a curve.
  struct Measures {
    const Quantity* quantity = nullptr;  // null: a curve
    std::size_t first = 0, count = 1;    // among all figures
  };

  /// The beds for the curves: one of each depth, with one plate of each size.
  std::vector<terrain::soil::PlateBed> beds_of_curves(const SoilOptions& options) const {
    std::map<double, std::map<std::pair<bool, double>, double>> deepest;  // by depth and plate: sinkage, m
    for (const PlateTarget& curve : curves_) {
      double& sinkage = deepest[curve.depth][{curve.disc, curve.size}];
      sinkage = std::max(sinkage, curve.sinkage.back() + window());
    }
    std::vector<terrain::soil::PlateBed> beds;
    for (const auto& [depth, sizes] : deepest) {
      std::vector<terrain::soil::PlateTest> plates;
      for (const auto& [plate, sinkage] : sizes) {
        plates.push_back(terrain::soil::plate_test(options, plate.second, plate.first, sinkage));
        plates.back().unload = false;
      }
      beds.push_back(terrain::soil::plate_bed(options, plates, depth));
    }
    return beds;
  }
  double window() const { return kWindow * 2.0 * grains_.radius; }  // m

  /// Adds the pressures of all curves after the quantities. @param beds of the plan, before those of the curves
  void add_curves(const terrain::soil::SoilPlan& plan, const SoilResults& results, std::size_t beds, double radius,
                  Prediction& found) const {
    for (const PlateTarget& curve : curves_) {
      std::vector<std::vector<double>> at(curve.sinkage.size());  // by point, then seed
      for (std::size_t bed = beds; bed < plan.plate_beds.size(); ++bed) {
        if (std::abs(plan.plate_beds[bed].box.depth * radius - curve.depth) > kSame) continue;
        for (const auto& [specimen, test] : results.plate[bed]) {
          if (test.disc != curve.disc || std::abs(test.size - curve.size) > kSame) continue;
          for (std::size_t k = 0; k < at.size(); ++k)
            at[k].push_back(pressure_in(curve.windows[k], test.curve.sinkage, test.curve.pressure));
        }
      }
      for (const std::vector<double>& seeds : at) {
        const Measured pressure = terrain::soil::mean_of(seeds);
        found.values.push_back(pressure.value), found.errors.push_back(pressure.standard_error);
      }
    }
  }

  /// All figures of the tests that targets need; NaN for the figures of other tests.
  Prediction tested(std::span<const double> values, const ProgressCall& progress) const {
    Prediction found;
    const double begin = processor_time(CLOCK_PROCESS_CPUTIME_ID);
    try {
      SoilOptions options;
      options.material = grains_of(values);
      options.seeds = tests_.seeds, options.speed = tests_.speed, options.stresses = tests_.stresses;
      options.threads = options.material.settle_threads;
      options.shear = options.repose = options.plate = options.cone = false;
      for (const Quantity& quantity : kQuantities)
        if (quantity.test && needed(quantity)) options.*quantity.test = true;
      const bool strips = options.plate;
      options.plate |= !curves_.empty();
      if (!options.repose && !options.plate && !options.cone) options.shear = true;  // for the density alone
      terrain::soil::SoilPlan plan = terrain::soil::soil_plan(options);
      if (!strips) plan.plate_beds.clear();
      const std::size_t beds = plan.plate_beds.size();
      for (terrain::soil::PlateBed& bed : beds_of_curves(options)) plan.plate_beds.push_back(std::move(bed));
      const SoilResults results = terrain::soil::run_soil_tests(options, plan, progress);
      SoilParameters p = terrain::soil::soil_parameters(results, plan, options.material.radius);
      if (p.repose_dry.samples == 0) p.repose_dry = p.repose;
      if (strips) p.k_c = p.beds.front().k_c, p.k_phi = p.beds.front().k_phi, p.n = p.beds.front().n;
      for (const Quantity& quantity : kQuantities) {
        const bool is = !quantity.test || options.*quantity.test;
        const Measured figure = quantity.measured ? p.*quantity.measured : bulk_density(results);
        found.values.push_back(is ? figure.value / quantity.unit : NAN);
        found.errors.push_back(is ? figure.standard_error / quantity.unit : NAN);
        if (needed(quantity) && !std::isfinite(figure.value))
          found.problem = fmt::format("the tests give no {}", quantity.name);
      }
      add_curves(plan, results, beds, options.material.radius, found);
    } catch (const Error& error) {
      if (error.code() != ExitCode::bad_input && error.code() != ExitCode::physics) throw;
      found.problem = error.what();
    }
    if (!found.problem.empty()) found.values.clear(), found.errors.clear();
    found.processor_time = processor_time(CLOCK_PROCESS_CPUTIME_ID) - begin;
    return found;
  }

  bool needed(const Quantity& quantity) const {
    return std::any_of(std::begin(kBothSets), std::end(kBothSets), [&](TargetSet set) {
      return std::any_of(measures_[set].begin(), measures_[set].end(),
                         [&](const Measures& target) { return target.quantity == &quantity; });
    });
  }

  /// Returns the value, from the study or a soil file; sets the target's `data` and `what`.
  static double target_value(OrderedJsonReader& reader, const Quantity& quantity, const std::filesystem::path& study,
                             Target& target) {
    const bool of_file = takes(reader, "data");
    if (of_file == takes(reader, "value"))
      reader.fail("value", "expected either 'value' or 'data', the name of a soil file that has it");
    const auto checked = [&](double value, const auto& wrong) {
      if (!(value >= quantity.least && value <= quantity.most))
        throw wrong(fmt::format("is {}, expected {} to {} for {}", number_text(value), number_text(quantity.least),
                                number_text(quantity.most), quantity.name));
      return value;
    };
    if (!of_file) {
      target.data = study, target.what = "measured";
      return checked(reader.number("value"), [&](const std::string& what) { return reader.wrong("value", what); });
    }
    target.data = find_file(reader.text("data"), reader.full("data"), study);
    target.what = target.data.filename().string();
    const std::string key(quantity.of_file);
    const auto wrong = [&](const std::string& what) {
      return input_error(target.data.string(), key.empty() ? "terrain" : "terrain." + key, what);
    };
    const nlohmann::json soil = scenario::read_soil_material(target.data);
    if (key.empty() || !soil.contains(key))
      throw wrong(fmt::format("is missing: soil files do not say {}, expected a 'value' in {} of {}", quantity.name,
                              reader.full("value"), study.string()));
    return checked(soil[key].get<double>(), wrong);
  }

  void read(OrderedJsonReader& reader, const std::filesystem::path& study, TargetSet set) {
    const std::string named = reader.text("quantity");
    const Quantity& quantity = entry_named(kQuantities, named, [&](const std::string& what) {
      return reader.wrong("quantity", "'" + named + "' " + what);
    });
    if (needed(quantity)) reader.fail("quantity", "is {} a second time, expected each once", quantity.name);
    Target target;
    target.name = target_name(reader, named);
    target.y.push_back(target_value(reader, quantity, study, target));
    if (!reader.given("sigma"))
      reader.fail("sigma", "is missing, expected the standard error of the value, in its unit");
    target.sigma.push_back(reader.positive("sigma"));
    reader.finish();
    target.x.push_back(0.0), target.y_name = named;
    target.labels.push_back(named);
    target.state = named + " " + state_;
    targets_[set].push_back(target);
    measures_[set].push_back({&quantity, static_cast<std::size_t>(&quantity - kQuantities.data())});
  }

  /// Reads a curve p(z) of a plate, in CSV.
  void read_curve(OrderedJsonReader& reader, const std::filesystem::path& study, TargetSet set) {
    TargetKeys keys = read_target_keys(reader, study);
    Target& target = keys.target;
    PlateTarget curve;
    curve.disc = takes(reader, "disc");
    if (takes(reader, "strip") == curve.disc)
      reader.fail("disc", "expected either 'disc', a diameter, or 'strip', a width, m");
    const auto length = [&](const char* key) {
      if (!reader.given(key)) reader.fail(key, "is missing, expected the depth of the bed, m");
      const double value = reader.positive(key);
      if (value > kMostSize) reader.fail(key, "is {} m, expected above 0 up to {:g} m", number_text(value), kMostSize);
      return value;
    };
    curve.size = length(curve.disc ? "disc" : "strip"), curve.depth = length("depth");
    const double relative = takes(reader, "relative_sigma") ? reader.positive("relative_sigma") : kUsualRelativeSigma;
    if (reader.given("relative_sigma") && keys.sigma > 0.0)
      reader.fail("relative_sigma", "is given with 'sigma', expected one of them");
    const int points = takes(reader, "points") ? reader.count("points", 2, kMostPoints) : kUsualPoints;
    reader.finish();
    target.what =
        fmt::format("{} {:g} mm on {:g} mm", curve.disc ? "disc" : "strip", 1e3 * curve.size, 1e3 * curve.depth);
    target.x_name = "sinkage_m", target.y_name = "pressure_Pa";
    take_points(target, curve, points);
    std::vector<double> sigma;
    if (keys.sigma == 0.0)
      for (const double p : target.y) sigma.push_back(relative * p);
    set_sigma(keys, sigma);
    target.state = fmt::format("{} {} {:.17g} {:.17g} {}", target.y_name, curve.disc, curve.size, curve.depth, state_);
    targets_[set].push_back(target);
    std::size_t first = kQuantities.size();
    for (const PlateTarget& before : curves_) first += before.sinkage.size();
    measures_[set].push_back({nullptr, first, curve.sinkage.size()});
    curves_.push_back(curve);
  }

  /// Evenly spaced sinkages from the diameter of a grain to the end of the measured curve, with its pressures there.
  void take_points(Target& target, PlateTarget& curve, int points) const {
    const CsvFile table(target.data, "a plate-sinkage test in CSV",
                        {"sinkage_m", "pressure_Pa", "seed", "width_m", "diameter_m", "bed_depth_m"});
    if (!table.has("pressure_Pa")) throw table.wrong(0, "has no column 'pressure_Pa' above it, expected one");
    std::map<double, double> measured;
    const auto differs = [&](std::size_t row, const char* column, double from, double most) {
      return table.has(column) && !(std::abs(table.number(row, column) - from) <= most);
    };
    for (std::size_t row = 0; row < table.row_count(); ++row) {
      if (differs(row, "diameter_m", curve.disc ? curve.size : 0.0, 1e-6)) continue;
      if (!curve.disc && differs(row, "width_m", curve.size, 1e-6)) continue;
      if (differs(row, "bed_depth_m", curve.depth, kOneBed * curve.depth)) continue;
      const double z = table.number(row, "sinkage_m");
      if (z >= 0.0) measured[z] = table.number(row, "pressure_Pa");
    }
    const std::string file = target.data.string();
    if (measured.size() < 2)
      throw input_error(file, "",
                        "has {} points of this plate on a bed of this depth with a sinkage of 0 or more, expected two "
                        "or more",
                        measured.size());
    std::vector<double> sinkage, pressure;
    for (const auto& [z, p] : measured) sinkage.push_back(z), pressure.push_back(p);
    const double diameter = 2.0 * grains_.radius, from = std::max(diameter, sinkage.front()), to = sinkage.back();
    if (to < kLeastReach * from)
      throw input_error(file, "sinkage_m",
                        "ends at {} m, expected {:.3g} m or more: curves are compared from the diameter of a grain on",
                        number_text(to), kLeastReach * from);
    if (to >= 0.5 * curve.depth)
      throw input_error(file, "sinkage_m", "ends at {} m, expected less than half of the depth of the bed, {} m",
                        number_text(to), number_text(curve.depth));
    for (int k = 0; k < points; ++k) {
      const double z = from + (to - from) * k / (points - 1);
      curve.sinkage.push_back(z);
      curve.windows.push_back({std::max(z - window(), sinkage.front()), std::min(z + window(), to)});
      target.x.push_back(z), target.y.push_back(pressure_in(curve.windows.back(), sinkage, pressure));
      if (const double soil = kLoose * grains_.density * grains_.gravity.norm() * z; !(target.y.back() > soil))
        throw input_error(
            file, "pressure_Pa",
            "is {:.3g} Pa at {:.3g} m, expected Pa, more than the soil above that depth weighs: {:.3g} Pa",
            target.y.back(), z, soil);
      target.labels.push_back(fmt::format("{} pressure_Pa at {:.3g} mm", target.name, 1e3 * z));
    }
  }

  /// Moves a target K that such grains cannot have to the held-out ones: fitting it would spoil the others.
  void leave_out_small_K(const CalibrationInput& input) {
    auto& [of_fitted, of_held_out] = measures_;
    const auto at = std::find_if(of_fitted.begin(), of_fitted.end(), [](const Measures& of) {
      return of.quantity && of.quantity->measured == &SoilParameters::K;
    });
    if (at == of_fitted.end() || fits("radius")) return;
    const auto target = targets_.fitted.begin() + (at - of_fitted.begin());
    const double least = kLeastK * 2.0 * grains_.radius;
    if (target->y.front() + 2.0 * target->sigma.front() >= least) return;
    notes_.push_back(fmt::format(
        "{} of {:g} mm cannot be reached with grains of {:g} mm diameter: it is not below {:g} mm, {:g} of the "
        "diameter, in any soil that was tested. It is compared, not fitted; a diameter of {:.2g} mm or less could "
        "reach it",
        target->name, 1e3 * target->y.front(), 2e3 * grains_.radius, 1e3 * least, kLeastK,
        1e3 * target->y.front() / kLeastK));
    targets_.held_out.push_back(*target), of_held_out.push_back(*at);
    targets_.fitted.erase(target), of_fitted.erase(at);
    if (targets_.fitted.empty())
      throw input_error(input.study.string(), "targets", "has no target that can be reached: " + notes_.back());
  }

  Settings set_;
  TestSettings tests_;
  DemOptions grains_;
  std::string state_;
  PerSet<std::vector<Measures>> measures_;           // of the targets
  std::vector<PlateTarget> curves_;                  // of both sets, in the order of their figures
  std::map<std::vector<double>, Prediction> known_;  // all figures, of this process
};

}  // namespace

CalibrationKind grain_kind() {
  CalibrationKind kind{"grains", "a scenario with grains", kGrainRules, read_model<GrainModel>, optimize_noisy,
                       true,     {"set", "tests"}};
  for (const Quantity& q : kQuantities) kind.quantities.push_back({q.name, q.least, q.most});
  return kind;
}

}  // namespace furrow::calibrate
