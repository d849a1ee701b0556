// Kind of calibration that fits grains to the strength of a soil: what the virtual soil tests (terrain/soil) measure on
// them against what was measured on the soil.
//
//   "start": "drawbar_pull_small.json", "set": {"terrain.material": "loose_sand.json"},   a scenario with grains
//   "tests": {"seeds": 2, "stresses": [5e3, 15e3, 40e3], "speed": 0.1},
//   "targets": [{"quantity": "friction_angle_deg", "data": "lete_sand.json", "sigma": 1.0},     value of a soil file
//               {"quantity": "bulk_density_kg_m3", "value": 1500, "sigma": 30}]
//
// Parameters are keys of the section `terrain`, quantities are figures of soil.json. A prediction is what `furrow soil`
// gives for the start with the parameters as settings, to the last bit, with its standard errors between beds. Only
// those tests run that the targets need. What a test gives for held-out targets is kept with the fitted ones of the
// same parameters.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "nodes/calibrate/kinds.hpp"
#include "nodes/calibrate/optimum.hpp"
#include "nodes/scenario/load_scenario.hpp"
#include "nodes/scenario/soil_material.hpp"
#include "nodes/study/study.hpp"
#include "protocol/core/clock.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/data_files.hpp"
#include "protocol/files/fields_json.hpp"
#include "protocol/files/json_text.hpp"
#include "terrain/soil/soil_tests.hpp"

namespace furrow::calibrate {
namespace {

using scenario::Settings;
using terrain::dem::DemOptions;
using terrain::soil::Measured, terrain::soil::SoilOptions, terrain::soil::SoilParameters, terrain::soil::SoilResults;

constexpr double kDegree = std::numbers::pi / 180.0;  // rad
/// K of the shear cell, in diameters of a grain, is above this for all soils of terrain/README.md (0.5 to 1.2 there).
constexpr double kLeastK = 0.45;
constexpr int kMostSeeds = 100;
constexpr double kMostSpeed = 10.0;  // m/s, as of `furrow soil`
constexpr double kMostStress = 1e7;  // Pa, as of `furrow soil`
constexpr std::size_t kMostStresses = 10;

const auto kRules = std::to_array<ParameterRule>({
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
});

// ---- what the tests measure

/// A figure of soil.json, and the key of soil files that says it to the engine scm.
struct Quantity {
  std::string_view name, of_file;
  bool SoilOptions::*test;             // that measures it; null: any
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

/// Of the beds of the first test that was made, in the order of their cost.
Measured bulk_density(const SoilResults& results) {
  std::vector<double> beds;
  const auto take = [&](const auto& tests) {
    if (!beds.empty()) return;
    for (std::size_t k = 0; k < tests.size(); ++k)  // several tests stand on one bed
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
      const scenario::Scenario scenario = scenario::load_scenario(start_, set_);
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
      for (OrderedJsonReader& reader : input.targets[set]) read(reader, input.study, set);
    leave_out_small_K(input);
  }

  std::vector<double> start_values() const override {
    std::vector<double> values;
    for (const std::string& name : names_) {
      const double value = *number_named(grains_, name);
      values.push_back(name == "settling_friction" && value < 0.0 ? NAN : value);
    }
    return values;
  }

  Prediction predict(std::span<const double> values, TargetSet set, const ProgressCall& progress) override {
    const std::vector<double> key(values.begin(), values.end());
    auto known = known_.find(key);
    if (known == known_.end()) known = known_.emplace(key, tested(values, progress)).first;
    const Prediction& found = known->second;
    if (!found.problem.empty()) return found;
    // All figures are kept; those of the set are asked for.
    Prediction part;
    part.processor_time = set == TargetSet::fitted ? found.processor_time : 0.0;
    for (const Quantity* quantity : quantities_[set]) {
      const auto at = static_cast<std::size_t>(quantity - kQuantities.data());
      part.values.push_back(found.values[at]), part.errors.push_back(found.errors[at]);
    }
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
    return scenario::load_scenario(start_, settings(values)).grains("only grains can be tested");
  }

  /// All figures of the tests that some target needs; NaN for those of others.
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
      if (!options.repose && !options.plate && !options.cone) options.shear = true;  // of the density alone
      const terrain::soil::SoilPlan plan = terrain::soil::soil_plan(options);
      const SoilResults results = terrain::soil::run_soil_tests(options, plan, progress);
      SoilParameters p = terrain::soil::soil_parameters(results, plan, options.material.radius);
      if (p.repose_dry.samples == 0) p.repose_dry = p.repose;
      for (const Quantity& quantity : kQuantities) {
        const bool is = !quantity.test || options.*quantity.test;
        const Measured figure = quantity.measured ? p.*quantity.measured : bulk_density(results);
        found.values.push_back(is ? figure.value / quantity.unit : NAN);
        found.errors.push_back(is ? figure.standard_error / quantity.unit : NAN);
        if (needed(quantity) && !std::isfinite(figure.value))
          found.problem = fmt::format("the tests give no {}", quantity.name);
      }
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
      return std::find(quantities_[set].begin(), quantities_[set].end(), &quantity) != quantities_[set].end();
    });
  }

  /// The value, of the study or of a soil file; sets the target's `data` and what it says.
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
    quantities_[set].push_back(&quantity);
  }

  /// A K that such grains cannot have is compared, and not fitted: it would spoil what can be.
  void leave_out_small_K(const CalibrationInput& input) {
    auto& [of_fitted, of_held_out] = quantities_;
    const auto at = std::find_if(of_fitted.begin(), of_fitted.end(),
                                 [](const Quantity* q) { return q->measured == &SoilParameters::K; });
    if (at == of_fitted.end() || fits("radius")) return;
    const auto target = targets_.fitted.begin() + (at - of_fitted.begin());
    const double least = kLeastK * 2.0 * grains_.radius;
    if (target->y.front() + 2.0 * target->sigma.front() >= least) return;
    notes_.push_back(fmt::format(
        "{} of {:g} mm cannot be reached with grains of {:g} mm diameter: it is not below {:g} mm, {:g} of the "
        "diameter, in any soil that was tested. It is compared, not fitted; grains of {:.2g} mm or less could reach it",
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
  PerSet<std::vector<const Quantity*>> quantities_;
  std::map<std::vector<double>, Prediction> known_;  // all figures, of this process
};

}  // namespace

CalibrationKind grain_kind() {
  CalibrationKind kind{"grains", "a scenario with grains", kRules, read_model<GrainModel>, optimize_noisy,
                       true,     {"set", "tests"}};
  for (const Quantity& q : kQuantities) kind.quantities.push_back({q.name, q.least, q.most});
  return kind;
}

}  // namespace furrow::calibrate
