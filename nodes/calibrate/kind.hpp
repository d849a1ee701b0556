// A kind of calibration: a model, its parameters, and the data with which it is compared.
//
// A kind is one entry of the table in kinds.cpp. The driver (calibrate.hpp), the optimizers and the results use a model
// only through this interface.
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

struct ParameterRule {
  std::string name;
  std::string unit;    // "-": none
  double least = 0.0;  // allowed range of bounds
  double most = 0.0;
  double lower = 0.0;  // bounds if the study gives none
  double upper = 0.0;
  bool logarithmic = true;  // scale if the study gives none; a bound of 0 needs a linear one
  std::string place = {};   // JSON pointer of its value in the start file, if the kind needs one
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

/// Data with which a model is compared: a curve y(x), or figures with names.
struct Target {
  std::string name;            // from the study; unique within it
  std::filesystem::path data;  // resolved
  std::string what;            // for users: "plate, 200 kPa"
  std::string x_name, y_name;  // with units, as columns of fit.csv: "deflection_m", "force_N"
  std::vector<double> x, y;
  std::vector<double> sigma;        // standard error of each y, by which its residual is divided
  std::vector<std::string> labels;  // of figures; empty: a curve
  std::string state;                // other inputs of a prediction, as text: for the digest of the evaluations
};
/// Number of points of all targets together.
std::size_t points_of(const std::vector<Target>& targets);

enum class TargetSet { fitted, held_out };
inline constexpr TargetSet kBothSets[] = {TargetSet::fitted, TargetSet::held_out};

/// A pair of values, one for each set of targets.
template <class T>
struct PerSet {
  T fitted, held_out;
  T& operator[](TargetSet set) { return set == TargetSet::fitted ? fitted : held_out; }
  const T& operator[](TargetSet set) const { return set == TargetSet::fitted ? fitted : held_out; }
};
inline constexpr PerSet<std::string_view> kSetNames{"fitted", "held_out"};

/// Predictions of a model for all points of a set of targets, one target after another.
struct Prediction {
  std::vector<double> values;   // in the units of the data
  std::vector<double> errors;   // their standard errors; empty: none
  std::string problem;          // why there are no values; empty: there are
  double processor_time = 0.0;  // computing time, s; 0: not measured, as for quick models
};

struct CalibrationInput {
  std::filesystem::path study;                     // its file, for messages and as the first place to search
  std::filesystem::path start;                     // resolved
  std::vector<std::string> parameters;             // those to fit, all of the kind, in the order of their values
  PerSet<std::vector<OrderedJsonReader>> targets;  // one object each; the kind reads its keys and calls finish()
  OrderedJsonReader whole;                         // the study, for the keys that are the kind's own
};

/// A file that a calibration writes in addition to the fitted one.
struct ResultFile {
  std::string name, text;
};

/// A kind's model with the data of a study.
class CalibrationModel {
 public:
  CalibrationModel() = default;
  explicit CalibrationModel(const CalibrationInput& input) : names_(input.parameters), start_(input.start) {}
  virtual ~CalibrationModel() = default;

  const std::vector<Target>& targets(TargetSet set) const { return targets_[set]; }
  /// Notes for the user before anything is computed, such as targets that cannot be reached.
  const std::vector<std::string>& notes() const { return notes_; }
  /// Values of the start file for each parameter of the input; NaN if it has none.
  virtual std::vector<double> start_values() const = 0;
  /// If the model has no answer to these parameters, Prediction::problem gives the reason.
  /// @param values of the parameters of the input, in their units
  /// @throws Error(stopped) from `progress`; Error(io, limit) if nothing can be computed at all
  virtual Prediction predict(std::span<const double> values, TargetSet set, const ProgressCall& progress) = 0;
  /// The file of the fitted model. @param source one paragraph about its origin
  virtual nlohmann::ordered_json fitted_file(std::span<const double> values, const std::string& source) const = 0;
  /// Further files; their number and names are the same for all values.
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

/// A figure for which targets of a kind may ask, with the range of its values in the unit of the name.
struct TargetQuantity {
  std::string_view name;
  double least, most;
};

struct CalibrationKind {
  std::string_view name;
  std::string_view start;  // description of the start file, for messages: "a tire file"
  std::span<const ParameterRule> parameters;
  /// @throws Error(bad_input) naming file and key
  std::unique_ptr<CalibrationModel> (*read)(CalibrationInput& input);
  /// Minimises the objective: optimize_smooth() for models that answer within milliseconds and without noise.
  Optimum (*optimize)(Objective& objective, const OptimizerOptions& options);
  /// Costly and noisy: the study may have the key `evaluations`, and may have no more points than parameters.
  bool noisy = false;
  std::vector<std::string_view> keys = {};      // of the study, that the kind reads from CalibrationInput::whole
  std::vector<TargetQuantity> quantities = {};  // of its targets; empty: they are curves of a test
};

/// Least number of evaluations for a noisy model with so many parameters: the surrogates need a slope, and a few are
/// added to the design.
constexpr int least_evaluations(std::size_t parameters) { return 2 * static_cast<int>(parameters) + 4; }
/// Number of evaluations if the study gives none.
constexpr int usual_evaluations(std::size_t parameters) { return 6 * static_cast<int>(parameters) + 4; }

/// Finds the entry of a table by its name.
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

/// Finds the number with this name in a list of fields; null: there is none.
template <class Options>
auto* number_named(Options& options, std::string_view name) {
  std::conditional_t<std::is_const_v<Options>, const double, double>* found = nullptr;
  visit_fields(options, [&](auto& value, const auto& field) {
    if constexpr (std::is_same_v<std::decay_t<decltype(value)>, double>)
      if (name == field.name) found = &value;
  });
  return found;
}

/// Checks whether an optional key is given. It may be null.
bool takes(OrderedJsonReader& reader, const std::string& key);

/// The keys that targets of every kind have: `data`, `name`, `sigma` and `weight`. The kind itself reads the points and
/// then calls set_sigma().
struct TargetKeys {
  Target target;        // name and data
  double sigma = 0.0;   // of every point, in the unit of y; 0: not given
  double weight = 1.0;  // of the squares
};
TargetKeys read_target_keys(OrderedJsonReader& reader, const std::filesystem::path& study);
std::string target_name(OrderedJsonReader& reader, const std::string& otherwise);

/// Sets target.sigma from the data file if it has errors, otherwise from the key, otherwise to a hundredth of the
/// largest |y|; divides it by √weight. @pre target.y is not empty
void set_sigma(TargetKeys& keys, const std::vector<double>& of_data);

}  // namespace furrow::calibrate
