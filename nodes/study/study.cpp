#include "nodes/study/study.hpp"

#include <algorithm>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "protocol/core/error.hpp"
#include "protocol/files/data_files.hpp"
#include "protocol/files/file_kind.hpp"
#include "protocol/files/json_reader.hpp"
#include "protocol/files/json_text.hpp"

namespace furrow::study {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kFormatVersion = 1;
constexpr std::size_t kMaxRuns = 10000;
constexpr double kMaxRest = 100.0;  // s
constexpr const char* kKeys[] = {"format_version", "description", "scenario", "set",     "grid",
                                 "list",           "passes",      "rest",     "results", "plot"};

using Reader = OrderedJsonReader;

Json load_document(const std::filesystem::path& file) {
  Json document = load_json<Json>(file, "a study in JSON");
  refuse_other_kinds(document, FileKind::study, file.string());
  return document;
}

bool given_text(const Json& document, const char* key) { return document.contains(key) && document[key].is_string(); }

/// All combinations of the values in `grid`; none of its keys is in `common`.
std::vector<Json> grid(Reader& reader, const Json& common) {
  std::vector<Json> runs{Json::object()};
  const Json axes = reader.object_or_empty("grid");
  for (const auto& [key, values] : axes.items()) {
    if (common.contains(key)) reader.fail("grid." + key, "is in 'set' as well, expected it in one of them");
    if (!values.is_array() || values.empty()) reader.fail("grid." + key, "expected a list of values, one or more");
    if (runs.size() * values.size() > kMaxRuns)
      reader.fail("grid", "makes more than {} runs, expected fewer", kMaxRuns);
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

std::vector<Json> list(Reader& reader) {
  const Json& entries = reader.array("list");
  if (entries.empty() || entries.size() > kMaxRuns)
    reader.fail("list", "has {} entries, expected 1 to {} objects {{ }} of keys and values", entries.size(), kMaxRuns);
  for (const Json& entry : entries)
    if (!entry.is_object()) reader.fail("list", "expected objects { } of keys and values in it");
  return entries.get<std::vector<Json>>();
}

double rest(Reader& reader) {
  if (!reader.given("rest")) return Study().rest;
  const double rest = reader.number("rest");
  if (rest < 0.0 || rest > kMaxRest) reader.fail("rest", "is {} s, expected 0 to {} s", number_text(rest), kMaxRest);
  return rest;
}

// Every table states which means are steady, and the share of late forces.
const std::vector<std::string> kSteadiness{"drawbar_pull_N.steady", "drawbar_pull_N.n_eff", "interface.share",
                                           "interface.ok"};

const std::vector<std::string> kUsualResults{"drawbar_pull_N.mean",  "drawbar_pull_N.sem",   "drawbar_pull_N.steady",
                                             "drawbar_pull_N.n_eff", "drawbar_coefficient",  "sinkage_m",
                                             "sinkage_sem_m",        "rut_depth_m",          "rut_depth_sem_m",
                                             "tractive_effort_N",    "terrain_resistance_N", "drive_torque_Nm",
                                             "tractive_efficiency",  "vertical_load_N",      "bed_clearance_m",
                                             "interface.share",      "interface.ok",         "wall_s"};

/// Refuses a plot whose means would be over runs that differ in more than the key of `mean_over`.
void check_means(Reader& reader, const Study& study, const Json& plot, const std::vector<std::string>& varied) {
  const std::string x = plot.value("x", ""), lines = plot.value("lines", ""), over = plot.value("mean_over", "");
  if (over.empty() || std::find(varied.begin(), varied.end(), x) == varied.end()) return;
  std::string also = study.passes > 1 && x != "pass" && lines != "pass" && over != "pass" ? "pass" : "";
  std::map<std::string, const Json*> first;  // run of a point
  for (const Json& run : study.runs) {
    const std::string point = run.value(x, Json()).dump() + run.value(lines, Json()).dump();
    const Json& other = *first.try_emplace(point, &run).first->second;
    for (const std::string& key : varied)
      if (key != over && run.value(key, Json()) != other.value(key, Json())) also = key;
  }
  if (!also.empty())
    reader.fail("plot.mean_over", "is '{}', but runs of one point differ in '{}' too, expected it as x or lines", over,
                also);
}

/// Checks a plot: lines and means are over keys that differ between runs, the ordinate is a result, the abscissa
/// either.
Json checked_plot(Reader& reader, const Study& study) {
  const std::vector<std::string> known{"x", "y", "error", "lines", "mean_over"};
  std::vector<std::string> varied;
  if (study.passes > 0) varied.emplace_back("pass");
  for (const Json& run : study.runs)
    for (const auto& [key, unused] : run.items())
      if (std::find(varied.begin(), varied.end(), key) == varied.end()) varied.push_back(key);
  Json plot = reader.object_or_empty("plot");
  for (const auto& [key, value] : plot.items()) {
    const std::string path = "plot." + key;
    if (std::find(known.begin(), known.end(), key) == known.end())
      reader.fail(path, "is unknown, expected one of: {}", fmt::join(known, ", "));
    if (!value.is_string()) reader.fail(path, "expected a text");
    const bool of_results = key == "y" || key == "error";
    std::vector<std::string> choice = of_results ? std::vector<std::string>() : varied;
    if (of_results || key == "x") choice.insert(choice.end(), study.results.begin(), study.results.end());
    if (std::find(choice.begin(), choice.end(), value.get<std::string>()) == choice.end())
      reader.fail(path, "is '{}', expected one of: {}", value.get<std::string>(), fmt::join(choice, ", "));
  }
  if (plot.contains("x") != plot.contains("y"))
    reader.fail(plot.contains("x") ? "plot.y" : "plot.x", "is missing, expected both x and y");
  check_means(reader, study, plot, varied);
  return plot;
}

}  // namespace

Study study_of_beds(const std::filesystem::path& scenario, const std::string& name, const scenario::Settings& settings,
                    std::uint64_t seed, int beds) {
  Study study;
  study.file = study.scenario = scenario;
  study.name = name;
  study.common = Json::object();
  for (const auto& [key, text] : settings) {
    study.common.erase(key);  // later keys win
    study.common[key] = text;
  }
  for (int k = 0; k < beds; ++k) {
    study.runs.push_back(Json::object({{"run.seed", seed + static_cast<std::uint64_t>(k)}}));
    study.names.push_back(fmt::format("seed{}", k + 1));
  }
  study.results = kUsualResults;
  return study;
}

Study load_study(const std::filesystem::path& name) {
  const std::filesystem::path file = named_file(name, {"rigs"});
  const Json document = load_document(file);
  Reader reader(document, file.string());
  reader.allow_only({std::begin(kKeys), std::end(kKeys)});
  reader.check_version(kFormatVersion);
  Study study;
  study.file = file;
  study.name = file.stem().string();
  if (given_text(document, "description")) study.description = document["description"];
  study.scenario = find_file(reader.text("scenario"), "scenario", file);
  study.common = reader.object_or_empty("set");
  const auto given = [&](const char* key) { return reader.given(key); };
  if (given("grid") && given("list")) reader.fail("", "has 'grid' and 'list', expected one of them");
  if (!given("grid") && !given("list") && !given("passes"))
    reader.fail("", "expected one of 'grid', 'list' and 'passes'");
  study.runs = given("list") ? list(reader) : grid(reader, study.common);
  for (auto run = study.runs.begin(); run != study.runs.end(); ++run)
    if (std::find(study.runs.begin(), run, *run) != run)
      reader.fail(given("list") ? "list" : "grid", "has the run '{}' twice, expected each once", text_of(*run));
  if (given("rest") && !given("passes")) reader.fail("rest", "is the time between passes, expected 'passes' as well");
  if (given("passes")) {
    study.passes = reader.count("passes", 1, 1000);
    study.rest = rest(reader);
    if (study.runs.size() * static_cast<std::size_t>(study.passes) > kMaxRuns)
      reader.fail("passes", "makes more than {} runs, expected fewer", kMaxRuns);
  }
  study.results = kUsualResults;
  if (given("results")) {
    const Json& results = reader.array("results");
    if (!std::all_of(results.begin(), results.end(), [](const Json& r) { return r.is_string(); }))
      reader.fail("results", "expected a list of keys of summary.json");
    study.results = study.chosen_results = results.get<std::vector<std::string>>();
    for (const std::string& name : kSteadiness)
      if (std::find(study.results.begin(), study.results.end(), name) == study.results.end())
        study.results.push_back(name);
  }
  if (given("plot")) study.plot = checked_plot(reader, study);
  return study;
}

scenario::Settings settings_of(const Json& values) {
  scenario::Settings settings;
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
