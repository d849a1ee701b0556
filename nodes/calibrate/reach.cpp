#include "nodes/calibrate/reach.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "protocol/files/digits.hpp"
#include "protocol/files/json_number.hpp"

namespace furrow::calibrate {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kWithin = 2.0;  // standard errors
constexpr std::array kStates{"reached", "out of range", "not together with the others", "not known"};

const char* name_of(ReachState state) { return kStates[static_cast<std::size_t>(state)]; }

/// Calls `visit(target, k, index among all points)` for every figure.
template <class Visit>
void each_figure(const std::vector<Target>& targets, Visit&& visit) {
  std::size_t at = 0;
  for (const Target& target : targets)
    for (std::size_t k = 0; k < target.y.size(); ++k) visit(target, k, at++);
}

}  // namespace

ReachState reach_state(const Reach& r, double data, double sigma) {
  if (r.error > kWithin * sigma) return ReachState::not_known;
  if (std::abs(r.value - data) <= kWithin * r.scale) return ReachState::reached;
  const bool beyond = data > r.high + kWithin * r.scale || data < r.low - kWithin * r.scale;
  return beyond ? ReachState::out_of_range : ReachState::not_together;
}

Json figures_json(const Target& target, const Prediction& prediction, std::size_t first,
                  const std::vector<Reach>& reach) {
  Json all = Json::array();
  for (std::size_t k = 0; k < target.labels.size(); ++k) {
    Json json{{"label", target.labels[k]}, {"target", target.y[k]}, {"sigma", target.sigma[k]}};
    const std::size_t at = first + k;
    if (at < prediction.values.size()) {
      json["evaluated"] = prediction.values[at];
      json["standard_error"] = at < prediction.errors.size() ? json_number(prediction.errors[at]) : Json();
    }
    if (at < reach.size()) {
      const Reach& r = reach[at];
      json["surrogate"] = {{"value", r.value}, {"standard_error", r.error}, {"noise", r.noise}};
      json["evaluations_span"] = {r.low, r.high};
      json["state"] = name_of(reach_state(r, target.y[k], target.sigma[k]));
    }
    all.push_back(json);
  }
  return all;
}

std::vector<std::string> reach_warnings(const std::vector<Target>& fitted, const std::vector<Reach>& reach) {
  std::vector<std::string> warnings;
  each_figure(fitted, [&](const Target& target, std::size_t k, std::size_t at) {
    const Reach& r = reach[at];
    const ReachState state = reach_state(r, target.y[k], target.sigma[k]);
    if (state == ReachState::reached) return;
    if (state == ReachState::not_known) {
      warnings.push_back(
          fmt::format("whether {} of {} is reached is not known: {}, expected an error of {} at most; "
                      "more beds ('seeds') or evaluations, or closer bounds tell more",
                      target.name, with_error(target.y[k], target.sigma[k]), with_error(r.value, r.error),
                      digits(kWithin * target.sigma[k])));
      return;
    }
    warnings.push_back(fmt::format("{} of {} is not reached but {}: {} ({} to {})", target.name,
                                   with_error(target.y[k], target.sigma[k]), with_error(r.value, r.error),
                                   state == ReachState::out_of_range
                                       ? "it is beyond all evaluations within these bounds"
                                       : "the evaluations span it, but not where the other targets are met",
                                   digits(r.low), digits(r.high)));
  });
  return warnings;
}

std::string reach_text(const std::vector<Target>& targets, const std::vector<Reach>& reach) {
  std::string text;
  each_figure(targets, [&](const Target& target, std::size_t k, std::size_t at) {
    text += fmt::format("{}{} {} (target {}, {})", text.empty() ? "" : ", ", target.name,
                        with_error(reach[at].value, reach[at].error), with_error(target.y[k], target.sigma[k]),
                        target.what);
  });
  return text;
}

Json measured_json(const std::vector<Target>& targets, const Prediction& prediction) {
  Json json = Json::object();
  each_figure(targets, [&](const Target& target, std::size_t k, std::size_t at) {
    if (at >= prediction.values.size()) return;
    json[target.labels[k]] = {
        {"mean", prediction.values[at]},
        {"standard_error", at < prediction.errors.size() ? json_number(prediction.errors[at]) : Json()}};
  });
  return json;
}

}  // namespace furrow::calibrate
