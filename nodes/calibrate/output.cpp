// Files that a calibration writes.
#include <algorithm>
#include <array>
#include <iterator>
#include <span>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "nodes/calibrate/calibrate.hpp"
#include "protocol/files/digits.hpp"
#include "protocol/files/json_number.hpp"
#include "protocol/files/text_file.hpp"

namespace furrow::calibrate {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kFormatVersion = 1;
constexpr std::array kStates{"reached", "out of range", "not together with the others", "not known"};

const char* name_of(ReachState state) { return kStates[static_cast<std::size_t>(state)]; }

Json number_or_null(const std::optional<double>& value) { return value ? json_number(*value) : Json(); }

const char* name_of(Bound bound) { return bound == Bound::lower ? "lower" : "upper"; }

Json parameters_json(const Calibration& calibration, const Confidence& confidence) {
  Json all = Json::object();
  for (std::size_t k = 0; k < calibration.parameters.size(); ++k) {
    const Parameter& p = calibration.parameters[k];
    const Estimate& e = confidence.estimates[k];
    all[p.name] = {{"value", e.value},
                   {"unit", p.unit},
                   {"standard_error", number_or_null(e.standard_error)},
                   {"interval_95", e.low ? Json{*e.low, *e.high} : Json()},
                   {"at_bound", e.at == Bound::none ? Json() : Json(name_of(e.at))},
                   {"start", p.start},
                   {"lower", p.lower},
                   {"upper", p.upper},
                   {"scale", p.logarithmic ? "log" : "linear"}};
  }
  return all;
}

/// Figures of a target. @param first of them among all points of the set
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

Json targets_json(const std::vector<Target>& targets, const Prediction& prediction,
                  const std::vector<Reach>& reach = {}) {
  Json all = Json::array();
  std::span<const double> rest = prediction.values;
  std::size_t first = 0;
  for (const Target& target : targets) {
    Json json{{"name", target.name}, {"data", target.data.filename().string()},
              {"what", target.what}, {"points", target.y.size()},
              {"x", target.x_name},  {"y", target.y_name}};
    if (!target.labels.empty()) json["figures"] = figures_json(target, prediction, first, reach);
    first += target.y.size();
    if (!prediction.problem.empty()) {
      json["problem"] = prediction.problem;
    } else {
      const Goodness g = goodness(target, rest.first(target.y.size()));
      rest = rest.subspan(target.y.size());
      json["r_squared"] = json_number(g.r_squared());
      json["largest_error"] = g.largest_error;
      json["largest_error_of_peak"] = json_number(g.largest_error / g.peak);
      json["root_mean_square_error"] = g.root_mean_square;
      json["peak"] = g.peak;
    }
    all.push_back(json);
  }
  return all;
}

double largest_of_peak(const Json& targets) {
  double largest = 0.0;
  for (const Json& target : targets)
    if (target.contains("largest_error_of_peak") && target["largest_error_of_peak"].is_number())
      largest = std::max(largest, target["largest_error_of_peak"].get<double>());
  return largest;
}

Json total_json(const std::vector<Target>& targets, const Prediction& prediction, const Json& each) {
  if (targets.empty() || !prediction.problem.empty()) return {};
  return {{"r_squared", json_number(joint_r_squared(targets, prediction.values))},
          {"largest_error_of_peak", largest_of_peak(each)}};
}

Json place_json(const Calibration& calibration, const Eigen::VectorXd& place) {
  Json json = Json::object();
  Eigen::Index k = 0;
  for (const Parameter& p : calibration.parameters) json[p.name] = p.off_scale(place[k++]);
  return json;
}

Json starts_json(const Calibration& calibration, const Optimum& optimum) {
  Json all = Json::array();
  for (const StartResult& start : optimum.starts)
    all.push_back({{"begin", place_json(calibration, start.begin)},
                   {"end", place_json(calibration, start.end)},
                   {"sum_of_squares", number_or_null(start.squares)},
                   {"iterations", start.iterations},
                   {"ended", start.ended}});
  return all;
}

Json identifiability_json(const Calibration& calibration, const Confidence& confidence) {
  Json undetermined = Json::array();
  for (const Undetermined& u : confidence.undetermined) {
    Json direction = Json::object();
    for (std::size_t k = 0; k < u.direction.size(); ++k) direction[calibration.parameters[k].name] = u.direction[k];
    undetermined.push_back({{"combination", combination_text(calibration.parameters, u.direction)},
                            {"direction", direction},
                            {"half_interval_95", json_number(u.half_interval)}});
  }
  return {{"singular_values", confidence.singular_values}, {"undetermined", undetermined}};
}

std::string fit_table(const Calibration& calibration, const CalibrationResults& results) {
  std::string text = "target,set,label,x,data,sigma,model\n";
  for (const TargetSet set : kBothSets) {
    const std::vector<double>& model = set == TargetSet::fitted ? results.fitted.values : results.held_out.values;
    each_figure(calibration.model->targets(set), [&](const Target& target, std::size_t k, std::size_t at) {
      fmt::format_to(std::back_inserter(text), "{},{},{},{:.12g},{:.12g},{:.6g},{}\n", target.name, kSetNames[set],
                     target.labels.empty() ? "" : target.labels[k], target.x[k], target.y[k], target.sigma[k],
                     at < model.size() ? fmt::format("{:.12g}", model[at]) : "");
    });
  }
  return text;
}

/// Lists "friction_angle_deg 31 ± 0.4 (target 31.1 ± 1)" for every figure.
std::string reach_text(const std::vector<Target>& targets, const std::vector<Reach>& reach) {
  std::string text;
  each_figure(targets, [&](const Target& target, std::size_t k, std::size_t at) {
    text += fmt::format("{}{} {} (target {}, {})", text.empty() ? "" : ", ", target.name,
                        with_error(reach[at].value, reach[at].error), with_error(target.y[k], target.sigma[k]),
                        target.what);
  });
  return text;
}

/// Content of `measured` in soil files: mean and standard error of every figure, as evaluated.
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

/// Describes the origin of the values in the fitted file.
std::string source_text(const Calibration& calibration, const CalibrationResults& results, const Json& summary) {
  const std::vector<Target>& targets = calibration.model->targets(TargetSet::fitted);
  std::vector<std::string> names, fitted;
  for (const Parameter& p : calibration.parameters) names.push_back(p.name);
  for (const Target& target : targets) fitted.push_back(fmt::format("{} ({})", target.name, target.what));
  const std::string how = results.optimum.known_errors
                              ? fmt::format(": {}; {} evaluations, {:.2g} minutes of processor time",
                                            reach_text(targets, results.optimum.reach), results.optimum.evaluations,
                                            results.processor_time / 60.0)
                              : fmt::format(" to {}: R² {:.5f}, largest error {:.2g} % of the peak",
                                            fmt::join(fitted, ", "), joint_r_squared(targets, results.fitted.values),
                                            100.0 * summary["fitted"]["largest_error_of_peak"].get<double>());
  std::string text = fmt::format("furrow calibrate {} of {} fitted {}{}. All other values are those of {}",
                                 FURROW_VERSION, calibration.file.filename().string(), fmt::join(names, ", "), how,
                                 calibration.start.filename().string());
  for (const std::string& warning : calibration_warnings(calibration, results)) text += ". Note: " + warning;
  return text;
}

}  // namespace

Json calibration_json(const Calibration& calibration, const CalibrationResults& results) {
  const std::vector<Target>&fitted = calibration.model->targets(TargetSet::fitted),
        &held_out = calibration.model->targets(TargetSet::held_out);
  Json json{{"format_version", kFormatVersion},    {"version", FURROW_VERSION},
            {"study", calibration.name},           {"description", calibration.description},
            {"calibrate", calibration.kind->name}, {"start", calibration.start.filename().string()},
            {"result", calibration.result}};
  const Json of_fitted = targets_json(fitted, results.fitted, results.optimum.reach),
             of_held_out = targets_json(held_out, results.held_out);
  json["fitted"] = total_json(fitted, results.fitted, of_fitted);
  json["held_out"] = total_json(held_out, results.held_out, of_held_out);
  json["parameters"] = parameters_json(calibration, results.confidence);
  json["targets"] = of_fitted;
  json["held_out_targets"] = of_held_out;
  json["identifiability"] = identifiability_json(calibration, results.confidence);
  json["sum_of_squares"] = results.optimum.squares;
  json["deviation"] = results.confidence.deviation;
  json["degrees_of_freedom"] = results.confidence.freedom;
  json["evaluations"] = results.asked;
  if (results.optimum.known_errors) {
    json["evaluations"] = results.optimum.evaluations;
    json["ended"] = results.optimum.ended;
    json["processor_s"] = results.processor_time;
  }
  json["starts"] = starts_json(calibration, results.optimum);
  json["warnings"] = calibration_warnings(calibration, results);
  return json;
}

void write_calibration(const Calibration& calibration, const CalibrationResults& results,
                       const std::filesystem::path& folder) {
  const Json summary = calibration_json(calibration, results);
  const std::string source = source_text(calibration, results, summary);
  Json file = calibration.model->fitted_file(results.values, source);
  if (results.optimum.known_errors)
    file["measured"].update(measured_json(calibration.model->targets(TargetSet::fitted), results.fitted));
  write_whole_file(folder / "fit.csv", fit_table(calibration, results));
  write_whole_file(folder / calibration.result, file.dump(2) + "\n");
  for (const ResultFile& further : calibration.model->further_files(results.values, source))
    write_whole_file(folder / further.name, further.text);
  write_whole_file(folder / kCalibration, summary.dump(2) + "\n");
}

}  // namespace furrow::calibrate
