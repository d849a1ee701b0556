#include "nodes/study/study.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "nodes/scenario/schema.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/data_files.hpp"
#include "protocol/files/json_text.hpp"

namespace furrow::study {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kFormatVersion = 1;
constexpr std::size_t kMaxRuns = 10000;
constexpr double kMaxRest = 100.0;  // s
constexpr const char* kKeys[] = {"format_version", "description", "scenario", "set",     "grid",
                                 "list",           "passes",      "rest",     "results", "plot"};

class Reader {
 public:
  explicit Reader(const std::filesystem::path& file) : file_(file.string()) {
    parse_json(read_text_file(file, "a study in JSON"), file_);  // says where mistakes stand
    root_ = Json::parse(read_text_file(file, "a study in JSON"));
    if (!root_.is_object()) throw wrong("", "is no object, expected { }");
    if (root_.contains("terrain") || root_.contains("tire"))
      throw wrong("", "is a scenario, expected a study ('furrow run' takes scenarios)");
    for (const auto& [key, value] : root_.items()) {
      const std::vector<std::string> known(std::begin(kKeys), std::end(kKeys));
      if (std::find(known.begin(), known.end(), key) != known.end()) continue;
      const auto similar = scenario::nearest_words(key, known);
      throw wrong(key, similar.empty()
                           ? fmt::format("is unknown, expected one of: {}", fmt::join(known, ", "))
                           : "is unknown, expected '" + similar.front() + "'?");
    }
    if (const Json version = value("format_version"); version.is_number_integer() && version > kFormatVersion)
      throw wrong("format_version",
                  fmt::format("is {}: the file is newer than this program, expected at most {}",
                              version.dump(), kFormatVersion));
  }

  Error wrong(const std::string& key, const std::string& what) const { return input_error(file_, key, what); }
  Json value(const char* key) const { return root_.contains(key) ? root_.at(key) : Json(); }

  Json object(const char* key) const {
    const Json found = value(key);
    if (found.is_null()) return Json::object();
    if (!found.is_object()) throw wrong(key, "expected an object { } of keys and values");
    return found;
  }

  std::string text(const char* key) const {
    const Json found = value(key);
    if (!found.is_string())
      throw wrong(key, found.is_null() ? "is missing, expected a text" : "expected a text");
    return found;
  }

  std::vector<Json> grid() const {
    std::vector<Json> runs{Json::object()};
    const Json axes = object("grid"), common = object("set");
    for (const auto& [key, values] : axes.items()) {
      if (common.contains(key)) throw wrong("grid." + key, "is in 'set' as well, expected it in one of them");
      if (!values.is_array() || values.empty())
        throw wrong("grid." + key, "expected a list of values, one or more");
      if (runs.size() * values.size() > kMaxRuns)
        throw wrong("grid", fmt::format("makes more than {} runs, expected fewer", kMaxRuns));
      std::vector<Json> more;
      for (const Json& run : runs)
        for (const Json& one : values) {
          more.push_back(run);
          more.back()[key] = one;
        }
      runs = more;
    }
    return runs;
  }

  std::vector<Json> list() const {
    const Json entries = value("list");
    if (!entries.is_array() || entries.empty() || entries.size() > kMaxRuns)
      throw wrong("list",
                  fmt::format("expected a list of 1 to {} objects {{ }} of keys and values", kMaxRuns));
    for (const Json& entry : entries)
      if (!entry.is_object()) throw wrong("list", "expected objects { } of keys and values in it");
    return entries.get<std::vector<Json>>();
  }

  int passes() const {
    const Json count = value("passes");
    if (!count.is_number_integer() || count < 1 || count > 1000)
      throw wrong("passes", "expected a whole number, 1 to 1000");
    return count;
  }

  double rest() const {
    const Json rest = value("rest");
    if (rest.is_null()) return Study().rest;
    if (!rest.is_number() || rest < 0.0 || rest > kMaxRest)
      throw wrong("rest", fmt::format("expected a number, 0 to {} s", kMaxRest));
    return rest;
  }

 private:
  std::string file_;
  Json root_;
};

const std::vector<std::string> kUsualResults{"drawbar_pull_N.mean",
                                             "drawbar_pull_N.sem",
                                             "drawbar_pull_N.steady",
                                             "drawbar_coefficient",
                                             "sinkage_m",
                                             "rut_depth_m",
                                             "tractive_effort_N",
                                             "terrain_resistance_N",
                                             "drive_torque_Nm",
                                             "tractive_efficiency",
                                             "vertical_load_N",
                                             "bed_clearance_m",
                                             "wall_s"};

/// Lines and means are over keys that the runs differ in, the ordinate is a result, the abscissa either.
Json checked_plot(const Reader& reader, const Study& study) {
  const std::vector<std::string> known{"x", "y", "error", "lines", "mean_over"};
  std::vector<std::string> varied;
  if (study.passes > 0) varied.emplace_back("pass");
  for (const Json& run : study.runs)
    for (const auto& [key, unused] : run.items())
      if (std::find(varied.begin(), varied.end(), key) == varied.end()) varied.push_back(key);
  Json plot = reader.object("plot");
  for (const auto& [key, value] : plot.items()) {
    const std::string path = "plot." + key;
    if (std::find(known.begin(), known.end(), key) == known.end())
      throw reader.wrong(path, fmt::format("is unknown, expected one of: {}", fmt::join(known, ", ")));
    if (!value.is_string()) throw reader.wrong(path, "expected a text");
    const bool of_results = key == "y" || key == "error";
    std::vector<std::string> choice = of_results ? std::vector<std::string>() : varied;
    if (of_results || key == "x") choice.insert(choice.end(), study.results.begin(), study.results.end());
    if (std::find(choice.begin(), choice.end(), value.get<std::string>()) == choice.end())
      throw reader.wrong(path, fmt::format("is '{}', expected one of: {}", value.get<std::string>(),
                                           fmt::join(choice, ", ")));
  }
  if (plot.contains("x") != plot.contains("y"))
    throw reader.wrong(plot.contains("x") ? "plot.y" : "plot.x", "is missing, expected both x and y");
  return plot;
}

}  // namespace

Study load_study(const std::filesystem::path& file) {
  const Reader reader(file);
  Study study;
  study.file = file;
  study.name = file.stem().string();
  study.scenario = find_file(reader.text("scenario"), "scenario", file);
  study.common = reader.object("set");
  const auto given = [&](const char* key) { return !reader.value(key).is_null(); };
  if (given("grid") && given("list")) throw reader.wrong("", "has 'grid' and 'list', expected one of them");
  if (!given("grid") && !given("list") && !given("passes"))
    throw reader.wrong("", "expected one of 'grid', 'list' and 'passes'");
  study.runs = given("list") ? reader.list() : reader.grid();
  for (auto run = study.runs.begin(); run != study.runs.end(); ++run)
    if (std::find(study.runs.begin(), run, *run) != run)
      throw reader.wrong(given("list") ? "list" : "grid",
                         fmt::format("has the run '{}' twice, expected each once", text_of(*run)));
  if (given("rest") && !given("passes"))
    throw reader.wrong("rest", "is the time between passes, expected 'passes' as well");
  if (given("passes")) {
    study.passes = reader.passes();
    study.rest = reader.rest();
    if (study.runs.size() * static_cast<std::size_t>(study.passes) > kMaxRuns)
      throw reader.wrong("passes", fmt::format("makes more than {} runs, expected fewer", kMaxRuns));
  }
  study.results = kUsualResults;
  if (const Json results = reader.value("results"); !results.is_null()) {
    if (!results.is_array() ||
        !std::all_of(results.begin(), results.end(), [](const Json& r) { return r.is_string(); }))
      throw reader.wrong("results", "expected a list of keys of summary.json");
    study.results = results.get<std::vector<std::string>>();
    study.results_chosen = true;
  }
  if (!reader.value("plot").is_null()) study.plot = checked_plot(reader, study);
  return study;
}

std::vector<std::pair<std::string, std::string>> settings_of(const Json& values) {
  std::vector<std::pair<std::string, std::string>> settings;
  for (const auto& [key, value] : values.items())
    settings.emplace_back(key, value.is_string() ? value.get<std::string>() : value.dump());
  return settings;
}

std::string text_of(const Json& values) {
  std::vector<std::string> parts;
  for (const auto& [key, value] : values.items())
    parts.push_back(key + "=" + (value.is_number() ? number_text(value.get<double>()) : value.dump()));
  return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace furrow::study
