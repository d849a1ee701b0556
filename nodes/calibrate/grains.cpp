#include "nodes/calibrate/grains.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "nodes/scenario/load_scenario.hpp"
#include "nodes/scenario/soil_material.hpp"
#include "nodes/study/study.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/data_files.hpp"
#include "protocol/files/fields_json.hpp"
#include "protocol/files/json_text.hpp"
#include "protocol/files/nearest_words.hpp"
#include "terrain/soil/soil_tests.hpp"

namespace furrow::calibrate {
namespace {

using terrain::dem::DemOptions;
using terrain::soil::Measured, terrain::soil::SoilOptions, terrain::soil::SoilParameters, terrain::soil::SoilResults;
using Settings = std::vector<std::pair<std::string, std::string>>;

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
    {"settling_friction", "-", 0.0, 10.0, 0.0, 0.5, false},
    {"compaction_pressure", "Pa", 0.0, 1e7, 0.0, 50e3, false},
    {"density", "kg/m³", 100.0, 2e4, 2000.0, 3000.0, false},
    {"young_modulus", "Pa", 1e5, 1e11, 1e7, 1e8, true},
});

/// The start's own value; NaN where it says none.
double value_of(const DemOptions& grains, const std::string& name) {
  double found = NAN;
  terrain::dem::visit_fields(
      [&](const auto& field, const auto& value) {
        if constexpr (std::is_same_v<std::decay_t<decltype(value)>, double>)
          if (name == field.name) found = value;
      },
      grains);
  return name == "settling_friction" && found < 0.0 ? NAN : found;
}

// ---- what the tests measure

enum class Test { shear, repose, plate, cone, any };
enum class Figure { cohesion, phi, phi_alone, K, repose, repose_dry, n, k_c, k_phi, cone_index, bulk_density };

/// A figure of soil.json, and the key of soil files that says it to the engine scm.
struct Quantity {
  std::string_view name, of_file;
  Test test;
  Figure figure;
  double least, most;  // of a target, in the unit of its name
};
constexpr auto kQuantities = std::to_array<Quantity>({
    {"friction_angle_deg", "mohr_friction_angle", Test::shear, Figure::phi, 0.0, 60.0},
    {"cohesion_Pa", "mohr_cohesion", Test::shear, Figure::cohesion, 0.0, 1e7},
    {"friction_angle_without_cohesion_deg", "", Test::shear, Figure::phi_alone, 0.0, 85.0},
    {"janosi_K_m", "janosi_k", Test::shear, Figure::K, 1e-6, 1.0},
    {"repose_angle_deg", "", Test::repose, Figure::repose, 0.0, 85.0},
    {"repose_angle_without_cohesion_deg", "", Test::repose, Figure::repose_dry, 0.0, 60.0},
    {"n", "bekker_n", Test::plate, Figure::n, 1e-3, 5.0},
    {"k_c", "bekker_k_c", Test::plate, Figure::k_c, -1e12, 1e12},
    {"k_phi", "bekker_k_phi", Test::plate, Figure::k_phi, 0.0, 1e13},
    {"cone_index_Pa", "", Test::cone, Figure::cone_index, 0.0, 1e9},
    {"bulk_density_kg_m3", "", Test::any, Figure::bulk_density, 50.0, 2e4},
});

struct Found {
  double value = 0.0, error = 0.0;
};

/// Of the beds of the first test that was made, in the order of their cost.
Found bulk_density(const SoilResults& results) {
  std::vector<double> beds;
  const auto take = [&](const auto& tests) {
    if (!beds.empty()) return;
    for (std::size_t k = 0; k < tests.size(); ++k)  // several tests stand on one bed
      if (k == 0 || tests[k].specimen.seed != tests[k - 1].specimen.seed)
        beds.push_back(tests[k].specimen.bulk_density);
  };
  take(results.shear), take(results.repose), take(results.plate), take(results.cone);
  const Measured mean = terrain::soil::mean_of(beds);
  return {mean.value, mean.standard_error};
}

Found figure_of(Figure figure, const SoilParameters& p, const SoilResults& results) {
  const auto in = [](const Measured& m, double unit = 1.0) { return Found{m.value / unit, m.standard_error / unit}; };
  switch (figure) {
    case Figure::cohesion:
      return in(p.cohesion);
    case Figure::phi:
      return in(p.phi, kDegree);
    case Figure::phi_alone:
      return in(p.phi_alone, kDegree);
    case Figure::K:
      return in(p.K);
    case Figure::repose:
      return in(p.repose, kDegree);
    case Figure::repose_dry:
      return in(p.repose_dry.samples > 0 ? p.repose_dry : p.repose, kDegree);
    case Figure::n:
      return in(p.n);
    case Figure::k_c:
      return in(p.k_c);
    case Figure::k_phi:
      return in(p.k_phi);
    case Figure::cone_index:
      return in(p.cone_index);
    case Figure::bulk_density:
      break;
  }
  return bulk_density(results);
}

double processor_time() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

// ---- the model

struct TestSettings {
  int seeds = 3;
  double speed = 0.1;            // m/s
  std::vector<double> stresses;  // Pa; empty: those of `furrow soil`
};

TestSettings read_tests(OrderedJsonReader& whole) {
  TestSettings tests;
  whole.skip("tests");
  if (!whole.given("tests")) return tests;
  OrderedJsonReader reader = whole.child("tests");
  reader.skip("seeds"), reader.skip("speed"), reader.skip("stresses");
  if (reader.given("seeds")) tests.seeds = reader.count("seeds", 1, kMostSeeds);
  if (reader.given("speed")) tests.speed = reader.positive("speed");
  if (tests.speed > kMostSpeed)
    reader.fail("speed",
                fmt::format("is {} m/s, expected above 0 up to {:g} m/s", number_text(tests.speed), kMostSpeed));
  if (reader.given("stresses")) {
    tests.stresses = reader.numbers("stresses");
    std::sort(tests.stresses.begin(), tests.stresses.end());
    const auto same = std::adjacent_find(tests.stresses.begin(), tests.stresses.end());
    if (tests.stresses.size() < 2 || tests.stresses.size() > kMostStresses || same != tests.stresses.end())
      reader.fail("stresses",
                  fmt::format("expected two to {} different normal stresses, Pa: c and φ are of a line through them",
                              kMostStresses));
    if (!(tests.stresses.front() > 0.0 && tests.stresses.back() <= kMostStress))
      reader.fail("stresses", fmt::format("has {} Pa, expected each above 0 up to {} Pa",
                                          number_text(tests.stresses.front() > 0.0 ? tests.stresses.back()
                                                                                   : tests.stresses.front()),
                                          number_text(kMostStress)));
  }
  reader.finish();
  return tests;
}

class GrainModel final : public CalibrationModel {
 public:
  explicit GrainModel(CalibrationInput& input) : names_(input.parameters), start_(input.start) {
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
      if (std::find(names_.begin(), names_.end(), key.starts_with("terrain.") ? key.substr(8) : "") != names_.end())
        throw input_error(input.study.string(), "set." + key, "is a parameter too, expected its 'start' there");
    state_ += fmt::format(" {} {:.17g} {}", tests_.seeds, tests_.speed, fmt::join(tests_.stresses, " "));
    read(input.targets, input.study, fitted_, of_fitted_);
    read(input.held_out, input.study, held_out_, of_held_out_);
    leave_out_small_K(input);
  }

  std::vector<double> start_values() const override {
    std::vector<double> values;
    for (const std::string& name : names_) values.push_back(value_of(grains_, name));
    return values;
  }

  std::vector<std::string> notes() const override { return notes_; }

  Prediction predict(std::span<const double> values, TargetSet set, const ProgressCall& progress) override {
    const std::vector<double> key(values.begin(), values.end());
    auto known = known_.find(key);
    if (known == known_.end()) known = known_.emplace(key, tested(values, progress)).first;
    Prediction found = known->second;
    if (!found.problem.empty()) return found;
    // All figures are kept; those of the set are asked for.
    Prediction part;
    part.processor_time = set == TargetSet::fitted ? found.processor_time : 0.0;
    for (const Quantity* quantity : set == TargetSet::fitted ? of_fitted_ : of_held_out_) {
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
    const double begin = processor_time();
    try {
      SoilOptions options;
      options.material = grains_of(values);
      options.seeds = tests_.seeds, options.speed = tests_.speed, options.stresses = tests_.stresses;
      options.threads = options.material.settle_threads;
      options.shear = needs(Test::shear), options.repose = needs(Test::repose);
      options.plate = needs(Test::plate), options.cone = needs(Test::cone);
      if (!options.repose && !options.plate && !options.cone) options.shear = true;  // of the density alone
      const terrain::soil::SoilPlan plan = terrain::soil::soil_plan(options);
      const SoilResults results = terrain::soil::run_soil_tests(options, plan, progress);
      const SoilParameters p = terrain::soil::soil_parameters(results, plan, options.material.radius);
      for (const Quantity& quantity : kQuantities) {
        const bool is = quantity.test == Test::any || needs(quantity.test);
        const Found figure = is ? figure_of(quantity.figure, p, results) : Found{NAN, NAN};
        found.values.push_back(figure.value), found.errors.push_back(figure.error);
        if (is && needed(quantity) && !std::isfinite(figure.value))
          found.problem = fmt::format("the tests give no {}", quantity.name);
      }
    } catch (const Error& error) {
      if (error.code() != ExitCode::bad_input && error.code() != ExitCode::physics) throw;
      found.problem = error.what();
    }
    if (!found.problem.empty()) found.values.clear(), found.errors.clear();
    found.processor_time = processor_time() - begin;
    return found;
  }

  bool needed(const Quantity& quantity) const {
    const auto in = [&](const std::vector<const Quantity*>& list) {
      return std::find(list.begin(), list.end(), &quantity) != list.end();
    };
    return in(of_fitted_) || in(of_held_out_);
  }
  bool needs(Test test) const {
    const auto in = [&](const std::vector<const Quantity*>& list) {
      return std::any_of(list.begin(), list.end(), [&](const Quantity* q) { return q->test == test; });
    };
    return in(of_fitted_) || in(of_held_out_);
  }

  const Quantity& quantity_of(OrderedJsonReader& reader) const {
    const std::string name = reader.text("quantity");
    std::vector<std::string> known;
    for (const Quantity& quantity : kQuantities) {
      if (quantity.name == name) return quantity;
      known.emplace_back(quantity.name);
    }
    reader.fail("quantity", "'" + name + "' " + unknown_text(nearest_words(name, known), known));
  }

  /// The value, of the study or of a soil file; sets the target's `data` and what it says.
  double target_value(OrderedJsonReader& reader, const Quantity& quantity, const std::filesystem::path& study,
                      Target& target) {
    reader.skip("data"), reader.skip("value");
    if (reader.given("data") == reader.given("value"))
      reader.fail("value", "expected either 'value' or 'data', the name of a soil file that has it");
    target.data = study;
    target.what = "measured";
    const auto outside = [&](double value) { return !(value >= quantity.least && value <= quantity.most); };
    const auto range = [&](double value) {
      return fmt::format("is {}, expected {} to {} for {}", number_text(value), number_text(quantity.least),
                         number_text(quantity.most), quantity.name);
    };
    if (reader.given("value")) {
      const double value = reader.number("value");
      if (outside(value)) reader.fail("value", range(value));
      return value;
    }
    target.data = find_file(reader.text("data"), reader.full("data"), study);
    target.what = target.data.filename().string();
    const nlohmann::json soil = scenario::read_soil_material(target.data);
    if (quantity.of_file.empty() || !soil.contains(quantity.of_file))
      throw input_error(target.data.string(),
                        quantity.of_file.empty() ? "terrain" : "terrain." + std::string(quantity.of_file),
                        fmt::format("is missing: soil files do not say {}, expected a 'value' in {} of {}",
                                    quantity.name, reader.full("value"), study.string()));
    const double value = soil[std::string(quantity.of_file)].get<double>();
    if (outside(value))
      throw input_error(target.data.string(), "terrain." + std::string(quantity.of_file), range(value));
    return value;
  }

  void read(std::vector<OrderedJsonReader>& readers, const std::filesystem::path& study, std::vector<Target>& targets,
            std::vector<const Quantity*>& quantities) {
    for (OrderedJsonReader& reader : readers) {
      const Quantity& quantity = quantity_of(reader);
      if (needed(quantity))
        reader.fail("quantity", fmt::format("is {} a second time, expected each once", quantity.name));
      Target target;
      target.name = reader.text_or("name", std::string(quantity.name));
      if (target.name.empty() || target.name.find_first_of(",\"") != std::string::npos)
        reader.fail("name", "expected a name without commas and quotes");
      target.y.push_back(target_value(reader, quantity, study, target));
      if (!reader.given("sigma"))
        reader.fail("sigma", "is missing, expected the standard error of the value, in its unit");
      target.sigma.push_back(reader.positive("sigma"));
      reader.finish();
      target.x.push_back(0.0), target.x_name = "", target.y_name = quantity.name;
      target.labels.emplace_back(quantity.name);
      target.state = std::string(quantity.name) + " " + state_;
      targets.push_back(target);
      quantities.push_back(&quantity);
    }
  }

  /// A K that such grains cannot have is compared, and not fitted: it would spoil what can be.
  void leave_out_small_K(const CalibrationInput& input) {
    const auto at =
        std::find_if(of_fitted_.begin(), of_fitted_.end(), [](const Quantity* q) { return q->figure == Figure::K; });
    if (at == of_fitted_.end() || std::find(names_.begin(), names_.end(), "radius") != names_.end()) return;
    const std::size_t k = static_cast<std::size_t>(at - of_fitted_.begin());
    const Target target = fitted_[k];
    const Quantity* const quantity = *at;
    const double least = kLeastK * 2.0 * grains_.radius;
    if (target.y.front() + 2.0 * target.sigma.front() >= least) return;
    notes_.push_back(
        fmt::format("{} of {:g} mm cannot be reached with grains of {:g} mm diameter: it is not below {:g} "
                    "mm, {:g} of the "
                    "diameter, in any soil that was tested. It is compared, not fitted; grains of {:.2g} mm "
                    "or less could reach it",
                    target.name, 1e3 * target.y.front(), 2e3 * grains_.radius, 1e3 * least, kLeastK,
                    1e3 * target.y.front() / kLeastK));
    fitted_.erase(fitted_.begin() + static_cast<std::ptrdiff_t>(k)), of_fitted_.erase(at);
    held_out_.push_back(target), of_held_out_.push_back(quantity);
    if (fitted_.empty())
      throw input_error(input.study.string(), "targets", "has no target that can be reached: " + notes_.back());
  }

  std::vector<std::string> names_;
  std::filesystem::path start_;
  Settings set_;
  TestSettings tests_;
  DemOptions grains_;
  std::string state_;
  std::vector<const Quantity*> of_fitted_, of_held_out_;
  std::vector<std::string> notes_;
  std::map<std::vector<double>, Prediction> known_;  // all figures, of this process
};

}  // namespace

std::span<const ParameterRule> grain_parameters() { return kRules; }

std::vector<TargetQuantity> grain_quantities() {
  std::vector<TargetQuantity> all;
  for (const Quantity& q : kQuantities) all.push_back({q.name, q.least, q.most});
  return all;
}

std::unique_ptr<CalibrationModel> read_grain_calibration(CalibrationInput& input) {
  return std::make_unique<GrainModel>(input);
}

}  // namespace furrow::calibrate
