#include "nodes/calibrate/check.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "protocol/files/json_text.hpp"

namespace furrow::calibrate {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kListed = 4;  // values of a target that are named one by one

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

std::string calibration_check_text(const Calibration& c) {
  std::string text;
  const auto line = [&](const std::string& name, const std::string& value) {
    text += fmt::format("{:<12} {}\n", name, value);
  };
  line("calibration", fmt::format("{}, kind {}", c.file.string(), c.kind->name));
  line("start", c.start.string());
  for (const Parameter& p : c.parameters)
    line("parameter", fmt::format("{}: {} to {}{}, {}, from {}", p.name, number_text(p.lower), number_text(p.upper),
                                  p.unit == "-" ? "" : " " + p.unit, p.logarithmic ? "logarithmic" : "linear",
                                  number_text(p.start)));
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
  for (const TargetSet set : {TargetSet::fitted, TargetSet::held_out}) {
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
