#include "nodes/calibrate/explain.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "nodes/calibrate/kind.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/json_text.hpp"
#include "protocol/files/nearest_words.hpp"

namespace furrow::calibrate {
namespace {

constexpr std::string_view kRoot = "calibrate";

constexpr auto kKeys = std::to_array<CalibrationKey>({
    {"format_version", "Version of the form of this file: 1."},
    {"description", "What the calibration is for, for people and 'furrow list'."},
    {"calibrate", "Kind of the model that is fitted."},
    {"start",
     "File that the fit begins from, relative to the study, then to the files that come with furrow. What is "
     "not fitted stays as it is there."},
    {"set", "Settings of the scenario that grains begin from, by dotted path, as of a study.", false},
    {"tests", "The virtual soil tests of each evaluation: seeds, stresses (Pa) and speed (m/s).", false},
    {"parameters", "What is fitted: an object of names, each with lower, upper, start and scale ('log' or 'linear')."},
    {"targets",
     "What is fitted to: a list of objects, each with data (a CSV file), name, sigma, weight and keys of the kind."},
    {"held_out", "What is predicted with the result and never fitted: a list as of targets."},
    {"starts", "Number of starts: that of the file, and random ones within the bounds. 1 to 1000, default 8."},
    {"seed", "Seed of the random starts. Default 1."},
    {"evaluations", "How often a noisy model is evaluated at most. Default 6 for each parameter, and 4 more.", false},
    {"result", "Name of the fitted file, in the folder of results. Default <start>_fitted.json."},
});

[[noreturn]] void refuse(const std::string& key, const std::string& last, const std::vector<std::string>& known) {
  throw input_error("explain", key, unknown_text(nearest_words(last, known), known));
}

std::string row(std::string_view name, std::string_view text) { return fmt::format("{:<24} {}\n", name, text); }

std::string range(double lower, double upper, const std::string& unit) {
  return fmt::format("{} to {}{}", number_text(lower), number_text(upper), unit == "-" ? "" : " " + unit);
}

std::string with_root(std::string_view name) { return fmt::format("{}.{}", kRoot, name); }

std::vector<std::string> parameters_of(const CalibrationKind& kind) {
  std::vector<std::string> names;
  for (const ParameterRule& rule : kind.parameters()) names.push_back(rule.name);
  return names;
}

std::string explain_all() {
  std::string text =
      "calibrate\n  A study that fits the parameters of a model to data, with the error of each: furrow "
      "calibrate STUDY.\n\nkeys of the file\n";
  for (const CalibrationKey& key : kKeys) text += row(with_root(key.name), key.meaning);
  text += "\nkinds\n";
  for (const CalibrationKind& kind : calibration_kinds())
    text += row(with_root(kind.name), fmt::format("Begins from {}.", kind.start));
  return text;
}

std::string explain_kind(const CalibrationKind& kind) {
  std::string text = fmt::format("{}\n  Begins from {}.\n\nparameters, with their bounds where the study gives none\n",
                                 with_root(kind.name), kind.start);
  for (const ParameterRule& rule : kind.parameters()) text += row(rule.name, range(rule.lower, rule.upper, rule.unit));
  if (!kind.quantities) return text;
  text += "\nquantities of targets, with the range of their values\n";
  for (const TargetQuantity& q : kind.quantities())
    text += fmt::format("{:<36} {}\n", q.name, range(q.least, q.most, "-"));
  return text;
}

std::string explain_parameter(const std::string& key, const ParameterRule& rule) {
  return fmt::format("{}\n  Parameter of a calibration.\n  {:<8} {}\n  {:<8} {}\n  {:<8} {}\n", key, "range",
                     range(rule.least, rule.most, rule.unit), "default", range(rule.lower, rule.upper, rule.unit),
                     "scale", rule.logarithmic ? "log" : "linear");
}

}  // namespace

std::span<const CalibrationKey> calibration_keys() { return kKeys; }

bool explains_calibrations(const std::string& key) { return key == kRoot || key.starts_with(with_root("")); }

std::string explain_calibration(const std::string& key) {
  if (key == kRoot) return explain_all();
  const std::string rest = key.substr(kRoot.size() + 1), first = rest.substr(0, rest.find('.'));
  const bool one_part = first.size() == rest.size();
  std::vector<std::string> known;
  for (const CalibrationKey& one : kKeys) {
    if (one_part && one.name == first) return fmt::format("{}\n  {}\n", key, one.meaning);
    known.emplace_back(one.name);
  }
  for (const CalibrationKind& kind : calibration_kinds()) {
    known.emplace_back(kind.name);
    if (kind.name != first) continue;
    if (one_part) return explain_kind(kind);
    const std::string parameter = rest.substr(first.size() + 1);
    for (const ParameterRule& rule : kind.parameters())
      if (rule.name == parameter) return explain_parameter(key, rule);
    refuse(key, parameter, parameters_of(kind));
  }
  refuse(key, first, known);
}

}  // namespace furrow::calibrate
