#include "nodes/checkpoint/run_summary.hpp"

#include <algorithm>
#include <cmath>

#include "nodes/launch/run_list.hpp"
#include "protocol/files/json_text.hpp"

namespace furrow::checkpoint {

using Json = nlohmann::ordered_json;

namespace {

constexpr std::size_t kMaxDigits = 9;  // of a place in a list

Json read_one(const std::filesystem::path& file) {
  Json summary = read_json_if_whole(file);
  if (!summary.is_object()) return {};
  const Json wheels = summary.value("wheels", Json::array());
  if (!wheels.is_array()) return summary;
  if (wheels.size() == 1) {
    for (const auto& [key, value] : wheels.front().items())
      if (!summary.contains(key)) summary[key] = value;
    return summary;
  }
  for (const Json& wheel : wheels) {
    if (!wheel.contains("drawbar_pull_N")) continue;
    Json& all = summary["drawbar_pull_N"]["steady"];
    if (all != false) all = value_at(wheel, "drawbar_pull_N.steady");
  }
  return summary;
}

}  // namespace

Json read_summary(const std::filesystem::path& run) { return read_one(run / "summary.json"); }

Json read_failed_summary(const std::filesystem::path& run) {
  Json summary = read_one(run / "summary_failed.json");
  return summary.is_object() && summary.value("failed", Json()).is_object() ? summary : Json();
}

std::int64_t finished_at(const std::filesystem::path& run) {
  const Json segments = value_at(read_summary(run), "segments");
  if (!segments.is_array() || segments.empty()) return -1;
  const Json step = value_at(segments.back(), "to_step");
  return step.is_number_integer() ? step.get<std::int64_t>() : -1;
}

std::vector<std::string> lost_results(const std::filesystem::path& run, bool frames) {
  if (!launch::has_run_list(run)) return {};
  std::vector<std::string> lost;
  std::error_code error;
  const launch::RunList list = launch::RunList::read(run);
  for (const std::string& form : list.forms())
    if ((form == "results.h5" || (form.starts_with("timeseries") && form.ends_with(".csv")) ||
         (frames && form == "frames/")) &&
        !std::filesystem::exists(run / form, error))
      lost.push_back(form);
  return lost;
}

bool ended_early(const std::filesystem::path& run) {
  const Json reason = value_at(read_summary(run), "end_reason");
  return reason.is_string() && reason != "run_end";
}

Json value_at(const Json& summary, const std::string& path) {
  const Json* at = &summary;
  for (std::size_t from = 0; from <= path.size();) {
    const std::size_t to = std::min(path.find('.', from), path.size());
    const std::string part = path.substr(from, to - from);
    const bool index =
        !part.empty() && part.size() <= kMaxDigits && part.find_first_not_of("0123456789") == std::string::npos;
    if (at->is_array() && index && std::stoul(part) < at->size())
      at = &(*at)[std::stoul(part)];
    else if (at->is_object() && at->contains(part))
      at = &(*at)[part];
    else
      return {};
    from = to + 1;
  }
  return *at;
}

double number_at(const Json& summary, const std::string& path) {
  const Json value = value_at(summary, path);
  return value.is_number() ? value.get<double>() : std::nan("");
}

}  // namespace furrow::checkpoint
