// What a calibration fits: a kind of model, its parameters, and the data that it is compared with.
//
// A kind is one entry of the table in kinds.cpp. The driver (calibrate.hpp), the optimizers and the results know a
// model by this interface alone.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <nlohmann/json.hpp>

#include "protocol/core/progress_call.hpp"
#include "protocol/files/json_reader.hpp"
#include "protocol/files/nearest_words.hpp"

namespace furrow::calibrate {

class Objective;
struct OptimizerOptions;
struct Optimum;

/// A parameter that a kind knows.
struct ParameterRule {
  std::string name;
  std::string unit;    // "-": none
  double least = 0.0;  // what bounds may be
  double most = 0.0;
  double lower = 0.0;  // bounds where the study gives none
  double upper = 0.0;
  bool logarithmic = true;  // scale where the study gives none; a bound of 0 needs a linear one
  std::string place = {};   // JSON pointer of its value in the start file, for kinds that need one
};

/// A parameter of a study. Optimizers see it on a scale from 0 (lower) to 1 (upper).
struct Parameter {
  std::string name, unit;
  double lower = 0.0, upper = 0.0;  // in its unit
  double start = 0.0;               // within them
  bool logarithmic = false;

  double on_scale(double value) const;
  double off_scale(double share) const;
  /// Derivative of the value by the share, in its unit.
  double slope(double share) const;
};

/// Data that a model is compared with: a curve y(x), or figures with names.
struct Target {
  std::string name;            // of the study; those of one study differ
  std::filesystem::path data;  // resolved
  std::string what;            // for people: "plate, 200 kPa"
  std::string x_name, y_name;  // with units, as columns of fit.csv: "deflection_m", "force_N"
  std::vector<double> x, y;
  std::vector<double> sigma;        // standard error of each y that its residual is divided by
  std::vector<std::string> labels;  // of figures; empty: a curve
  std::string state;                // what else a prediction depends on, as text: for the digest of the evaluations
};
/// Of all targets together.
std::size_t points_of(const std::vector<Target>& targets);

/// Which targets a prediction is for.
enum class TargetSet { fitted, held_out };
inline constexpr TargetSet kBothSets[] = {TargetSet::fitted, TargetSet::held_out};

/// One of something for each set of targets.
template <class T>
struct PerSet {
  T fitted, held_out;
  T& operator[](TargetSet set) { return set == TargetSet::fitted ? fitted : held_out; }
  const T& operator[](TargetSet set) const { return set == TargetSet::fitted ? fitted : held_out; }
};
inline constexpr PerSet<std::string_view> kSetNames{"fitted", "held_out"};

/// What a model says of all points of a set of targets, one target after another.
struct Prediction {
  std::vector<double> values;   // in the units of the data
  std::vector<double> errors;   // their standard errors; empty: none
  std::string problem;          // why there are no values; empty: there are
  double processor_time = 0.0;  // that it took, s; 0: not told, as of quick models
};

/// What a kind makes its model from.
struct CalibrationInput {
  std::filesystem::path study;                     // its file, for messages and as the first place to look in
  std::filesystem::path start;                     // resolved
  std::vector<std::string> parameters;             // those to fit, all known to the kind, in the order of their values
  PerSet<std::vector<OrderedJsonReader>> targets;  // one object each; the kind takes its keys and calls finish()
  OrderedJsonReader whole;                         // the study, for the keys that are the kind's own
};

/// A file that a calibration leaves in addition to the fitted one.
struct ResultFile {
  std::string name, text;
};

/// A kind's model with its data, as a study asks for it.
class CalibrationModel {
 public:
  CalibrationModel() = default;
  explicit CalibrationModel(const CalibrationInput& input) : names_(input.parameters), start_(input.start) {}
  virtual ~CalibrationModel() = default;

  const std::vector<Target>& targets(TargetSet set) const { return targets_[set]; }
  /// What a user must know before anything is computed, such as targets that cannot be reached.
  const std::vector<std::string>& notes() const { return notes_; }
  /// What the start file has for each parameter of the input, NaN where it says nothing.
  virtual std::vector<double> start_values() const = 0;
  /// A model that has no answer to these parameters says so in Prediction::problem.
  /// @param values of the parameters of the input, in their units
  /// @throws Error(stopped) from `progress`; Error(io, limit) where nothing can be computed at all
  virtual Prediction predict(std::span<const double> values, TargetSet set, const ProgressCall& progress) = 0;
  /// The file of the fitted model. @param source one paragraph that says where it comes from
  virtual nlohmann::ordered_json fitted_file(std::span<const double> values, const std::string& source) const = 0;
  /// Alike in number and names for all values.
  virtual std::vector<ResultFile> further_files(std::span<const double>, const std::string&) const { return {}; }

 protected:
  bool fits(std::string_view name) const;

  std::vector<std::string> names_;  // of the parameters of the input
  std::filesystem::path start_;
  PerSet<std::vector<Target>> targets_;
  std::vector<std::string> notes_;
};

template <class Model>
std::unique_ptr<CalibrationModel> read_model(CalibrationInput& input) {
  return std::make_unique<Model>(input);
}

/// A figure that targets of a kind may ask for by name, with the range of its values in the unit of the name.
struct TargetQuantity {
  std::string_view name;
  double least, most;
};

struct CalibrationKind {
  std::string_view name;
  std::string_view start;  // what the start file is, for messages: "a tire file"
  std::span<const ParameterRule> parameters;
  /// @throws Error(bad_input) naming file and key
  std::unique_ptr<CalibrationModel> (*read)(CalibrationInput& input);
  /// The least of the objective: optimize_smooth() for models that answer within milliseconds and without noise.
  Optimum (*optimize)(Objective& objective, const OptimizerOptions& options);
  /// Costly and noisy: the study may have the key `evaluations`, and as many parameters as points.
  bool noisy = false;
  std::vector<std::string_view> keys = {};      // of the study, that the kind reads from CalibrationInput::whole
  std::vector<TargetQuantity> quantities = {};  // of its targets; none: they are curves of a test
};

/// What a study of so many parameters of a noisy model needs at least: surrogates with a slope, and a few in addition
/// to the design.
constexpr int least_evaluations(std::size_t parameters) { return 2 * static_cast<int>(parameters) + 4; }
/// What it takes where the study says nothing.
constexpr int usual_evaluations(std::size_t parameters) { return 6 * static_cast<int>(parameters) + 4; }

/// The entry of a table that has this name.
/// @param wrong makes the error from "is unknown, expected …"
template <class Table, class Wrong>
const auto& entry_named(const Table& table, std::string_view name, const Wrong& wrong) {
  std::vector<std::string> known;
  for (const auto& entry : table) {
    if (entry.name == name) return entry;
    known.emplace_back(entry.name);
  }
  throw wrong(unknown_text(nearest_words(std::string(name), known), known));
}

/// The number of this name in a list of fields; null: there is none.
template <class Options>
auto* number_named(Options& options, std::string_view name) {
  std::conditional_t<std::is_const_v<Options>, const double, double>* found = nullptr;
  visit_fields(options, [&](auto& value, const auto& field) {
    if constexpr (std::is_same_v<std::decay_t<decltype(value)>, double>)
      if (name == field.name) found = &value;
  });
  return found;
}

/// Whether an optional key is given. It may be null.
bool takes(OrderedJsonReader& reader, const std::string& key);

/// The keys that targets of every kind have: `data`, `name`, `sigma` and `weight`. The points are the kind's to read;
/// then set_sigma().
struct TargetKeys {
  Target target;        // name and data
  double sigma = 0.0;   // of every point, in the unit of y; 0: not given
  double weight = 1.0;  // of the squares
};
TargetKeys read_target_keys(OrderedJsonReader& reader, const std::filesystem::path& study);
std::string target_name(OrderedJsonReader& reader, const std::string& otherwise);

/// Sets target.sigma: that of the data file where it has some, else the key's, else a hundredth of the largest |y|;
/// divided by √weight. @pre target.y is not empty
void set_sigma(TargetKeys& keys, const std::vector<double>& of_data);

}  // namespace furrow::calibrate
