#include "nodes/calibrate/explain.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "nodes/calibrate/kinds.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/json_text.hpp"

namespace furrow::calibrate {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kRoot = "calibrate";
constexpr std::size_t kListed = 4;  // values of a target that are listed one by one

std::string row(std::string_view name, std::string_view text) { return fmt::format("{:<24} {}\n", name, text); }

std::string range(double lower, double upper, const std::string& unit) {
  return fmt::format("{} to {}{}", number_text(lower), number_text(upper), unit == "-" ? "" : " " + unit);
}

std::string with_root(std::string_view name) { return fmt::format("{}.{}", kRoot, name); }

std::string explain_all() {
  std::string text =
      "calibrate\n  A study that fits the parameters of a model to data, with the error of each: furrow calibrate "
      "STUDY.\n\nkeys of the file\n";
  for (const CalibrationKey& key : calibration_keys()) text += row(with_root(key.name), key.meaning);
  text += "\nkinds\n";
  for (const CalibrationKind& kind : calibration_kinds())
    text += row(with_root(kind.name), fmt::format("Begins from {}.", kind.start));
  return text;
}

std::string explain_kind(const CalibrationKind& kind) {
  std::string text = fmt::format("{}\n  Begins from {}.\n\nparameters, with their bounds where the study gives none\n",
                                 with_root(kind.name), kind.start);
  for (const ParameterRule& rule : kind.parameters) text += row(rule.name, range(rule.lower, rule.upper, rule.unit));
  if (kind.quantities.empty()) return text;
  text += "\nquantities of targets, with the range of their values\n";
  for (const TargetQuantity& q : kind.quantities)
    text += fmt::format("{:<36} {}\n", q.name, range(q.least, q.most, "-"));
  return text;
}

std::string explain_parameter(const std::string& key, const ParameterRule& rule) {
  return fmt::format("{}\n  Parameter of a calibration.\n  {:<8} {}\n  {:<8} {}\n  {:<8} {}\n", key, "range",
                     range(rule.least, rule.most, rule.unit), "default", range(rule.lower, rule.upper, rule.unit),
                     "scale", rule.logarithmic ? "log" : "linear");
}

std::string span_of(const std::vector<double>& values, const std::string& name) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return fmt::format("{} {} to {}", name, number_text(*least), number_text(*most));
}

std::string target_text(const Target& target) {
  std::string text = fmt::format("{} ({}): ", target.name, target.what);
  const auto [least, most] = std::minmax_element(target.sigma.begin(), target.sigma.end());
  if (target.labels.empty())
    text += fmt::format("{} points, {}, {}", target.y.size(), span_of(target.x, target.x_name),
                        span_of(target.y, target.y_name));
  else if (target.y.size() > kListed)
    text += span_of(target.y, fmt::format("{} values,", target.y.size())) +
            (*least < *most ? ", " + span_of(target.sigma, "each ±") : ", each ± " + number_text(*least));
  else
    for (std::size_t k = 0; k < target.y.size(); ++k)
      text += fmt::format("{}{} {} ± {}", k == 0 ? "" : ", ", target.labels[k], number_text(target.y[k]),
                          number_text(target.sigma[k]));
  return text;
}

Json target_json(const Target& target) {
  return {{"name", target.name},       {"what", target.what}, {"data", target.data.string()},
          {"points", target.y.size()}, {"x", target.x_name},  {"y", target.y_name}};
}

}  // namespace

bool explains_calibrations(const std::string& key) { return key == kRoot || key.starts_with(with_root("")); }

std::string explain_calibration(const std::string& key) {
  if (key == kRoot) return explain_all();
  const std::string rest = key.substr(kRoot.size() + 1), first = rest.substr(0, rest.find('.'));
  const bool one_part = first.size() == rest.size();
  const auto wrong = [&](const std::string& what) { return input_error("explain", key, what); };
  std::vector<CalibrationKey> known(calibration_keys().begin(), calibration_keys().end());
  for (const CalibrationKind& kind : calibration_kinds()) {
    known.push_back({kind.name, ""});
    if (kind.name != first) continue;
    if (one_part) return explain_kind(kind);
    return explain_parameter(key, entry_named(kind.parameters, rest.substr(first.size() + 1), wrong));
  }
  const CalibrationKey& found = entry_named(known, one_part ? first : rest, wrong);
  return fmt::format("{}\n  {}\n", key, found.meaning);
}

std::string calibration_check_text(const Calibration& c) {
  std::string text;
  const auto line = [&](const std::string& name, const std::string& value) {
    text += fmt::format("{:<12} {}\n", name, value);
  };
  line("calibration", fmt::format("{}, kind {}", c.file.string(), c.kind->name));
  line("start", c.start.string());
  for (const Parameter& p : c.parameters)
    line("parameter", fmt::format("{}: {}, {}, from {}", p.name, range(p.lower, p.upper, p.unit),
                                  p.logarithmic ? "logarithmic" : "linear", number_text(p.start)));
  for (const Target& target : c.model->targets(TargetSet::fitted)) line("target", target_text(target));
  for (const Target& target : c.model->targets(TargetSet::held_out)) line("held out", target_text(target));
  if (c.kind->noisy)
    line("evaluations", fmt::format("at most {}, seed {}", c.evaluations, c.seed));
  else
    line("starts", fmt::format("{}, seed {}", c.starts, c.seed));
  line("result", c.result);
  return text;
}

Json calibration_check_json(const Calibration& c) {
  Json json{{"format_version", 1},  {"calibration", c.file.string()}, {"description", c.description},
            {"kind", c.kind->name}, {"start", c.start.string()},      {"parameters", Json::object()}};
  for (const Parameter& p : c.parameters)
    json["parameters"][p.name] = {{"unit", p.unit},
                                  {"lower", p.lower},
                                  {"upper", p.upper},
                                  {"scale", p.logarithmic ? "log" : "linear"},
                                  {"start", p.start}};
  for (const TargetSet set : kBothSets) {
    Json& list = json[set == TargetSet::fitted ? "targets" : "held_out"] = Json::array();
    for (const Target& target : c.model->targets(set)) list.push_back(target_json(target));
  }
  if (c.kind->noisy)
    json["evaluations"] = c.evaluations;
  else
    json["starts"] = c.starts;
  json["seed"] = c.seed;
  json["result"] = c.result;
  return json;
}

}  // namespace furrow::calibrate
