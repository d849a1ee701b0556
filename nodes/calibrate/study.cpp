#include "nodes/calibrate/study.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "nodes/calibrate/kinds.hpp"
#include "protocol/core/error.hpp"
#include "protocol/core/hash.hpp"
#include "protocol/files/data_files.hpp"
#include "protocol/files/file_kind.hpp"
#include "protocol/files/json_text.hpp"
#include "protocol/files/text_file.hpp"

namespace furrow::calibrate {
namespace {

using Json = nlohmann::ordered_json;
using Reader = OrderedJsonReader;

constexpr int kStudyVersion = 1;
constexpr int kMostEvaluations = 1000, kMostStarts = 1000, kMostTargets = 1000, kLargestSeed = 2147483647;
/// Names of a calibration's result files.
constexpr const char* kTaken[] = {"calibration.json", "sweep.json", "summary.json", "scenario.json"};

constexpr auto kKeys = std::to_array<CalibrationKey>({
    {"format_version", "Version of the form of this file: 1."},
    {"description", "What the calibration is for, for people and 'furrow list'."},
    {"calibrate", "Kind of the model that is fitted."},
    {"start",
     "File that the fit begins from, relative to the study, then to the files that come with furrow. What is not "
     "fitted stays as it is there."},
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

bool is_logarithmic(Reader& reader, const ParameterRule& rule) {
  const std::string scale = reader.text_or("scale", rule.logarithmic ? "log" : "linear");
  if (scale != "log" && scale != "linear") reader.fail("scale", "is '" + scale + "', expected 'log' or 'linear'");
  return scale == "log";
}

/// Name, bounds and scale; `start` is NaN if the study gives none.
Parameter parameter_of(Reader reader, const ParameterRule& rule) {
  Parameter p{rule.name, rule.unit, rule.lower, rule.upper, NAN, is_logarithmic(reader, rule)};
  const auto read = [&](const char* key, double& value, double least, double most, const char* expected) {
    if (takes(reader, key)) value = reader.number(key);
    if (value < least || value > most)
      reader.fail(key, "is {}, expected {}{} to {} {}", number_text(value), expected, number_text(least),
                  number_text(most), rule.unit);
  };
  read("lower", p.lower, rule.least, rule.most, ""), read("upper", p.upper, rule.least, rule.most, "");
  read("start", p.start, p.lower, p.upper, "a value from lower to upper, ");
  if (!(p.lower < p.upper))
    reader.fail("upper", "is {}, expected more than lower, {}", number_text(p.upper), number_text(p.lower));
  if (p.logarithmic && !(p.lower > 0.0))
    reader.fail("lower", "is {}, expected above 0 for the scale 'log'", number_text(p.lower));
  reader.finish();
  return p;
}

std::vector<Parameter> parameters_of(Reader& reader, const CalibrationKind& kind) {
  (void)reader.child("parameters");
  std::vector<Parameter> parameters;
  for (const auto& [name, value] : reader.object().at("parameters").items()) {
    const std::string path = "parameters." + name;
    if (!value.is_object())
      reader.fail(path, "is " + value_text(value) + ", expected an object { } with lower, upper, start, scale");
    parameters.push_back(parameter_of(
        Reader(value, reader.file(), path),
        entry_named(kind.parameters, name, [&](const std::string& what) { return reader.wrong(path, what); })));
  }
  if (parameters.empty()) reader.fail("parameters", "is empty, expected one parameter or more");
  return parameters;
}

std::vector<Reader> targets_of(Reader& reader, const std::string& key, std::size_t least) {
  if (least == 0 && !takes(reader, key)) return {};
  const Json& list = reader.array(key);
  if (list.size() < least || list.size() > kMostTargets)
    reader.fail(key, "has {} entries, expected {} to {}", list.size(), least, kMostTargets);
  std::vector<Reader> readers;
  for (std::size_t k = 0; k < list.size(); ++k) {
    const std::string path = fmt::format("{}[{}]", key, k);
    if (!list[k].is_object())
      reader.fail(path, "is " + value_text(list[k]) + ", expected an object { } that names 'data'");
    readers.emplace_back(list[k], reader.file(), path);
  }
  return readers;
}

void require_names(const Reader& reader, const CalibrationModel& model) {
  std::set<std::string> names;
  for (const TargetSet set : kBothSets)
    for (const Target& target : model.targets(set))
      if (!names.insert(target.name).second)
        reader.fail(set == TargetSet::fitted ? "targets" : "held_out",
                    "has the name '" + target.name + "' twice in this study, expected another 'name' for one of them");
}

void take_starts(std::vector<Parameter>& parameters, const CalibrationModel& model, const Reader& reader) {
  const std::vector<double> given = model.start_values();
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    Parameter& p = parameters[k];
    if (std::isfinite(p.start)) continue;
    p.start = given[k];
    if (!std::isfinite(p.start))
      reader.fail("parameters." + p.name, "has no 'start', and the start file has no such value, expected a 'start'");
    if (p.start < p.lower || p.start > p.upper)
      reader.fail("parameters." + p.name,
                  "begins at {} {}, which is the start file's, expected bounds around it or a 'start' within {} to {}",
                  number_text(p.start), p.unit, number_text(p.lower), number_text(p.upper));
  }
}

std::string result_name(Reader& reader, const Calibration& c) {
  const std::string name = reader.text_or("result", c.start.stem().string() + "_fitted.json");
  const bool taken = std::find(std::begin(kTaken), std::end(kTaken), name) != std::end(kTaken);
  if (taken || std::filesystem::path(name).filename() != name || !name.ends_with(".json") || name[0] == '.')
    reader.fail("result", "is '" + name + "', expected the name of a .json file without a folder, " +
                              (taken ? "not that of another result" : "which is written into the folder of results"));
  return name;
}

/// Bounds, starts and held-out targets are left out: they may change while evaluations remain valid.
std::string digest_of(const Calibration& c) {
  Hash hash;
  const auto add = [&hash](const std::string& text) { hash.add(text), hash.add("\n"); };
  add(FURROW_VERSION), add(std::string(c.kind->name));
  add_file(hash, c.start);
  for (const Parameter& p : c.parameters) add(p.name);
  for (const Target& t : c.model->targets(TargetSet::fitted)) {
    add(t.state);
    hash.add(std::span<const double>(t.x));
    for (const std::string& label : t.labels) add(label);
  }
  return hash.hex();
}

}  // namespace

std::span<const CalibrationKey> calibration_keys() { return kKeys; }

bool is_calibration(const std::filesystem::path& name) {
  std::error_code error;
  const std::filesystem::path file = named_file(name, {"rigs"});
  if (!std::filesystem::is_regular_file(file, error)) return false;
  return kind_of_file(read_json_if_whole(file)) == FileKind::calibration;
}

Calibration load_calibration(const std::filesystem::path& name) {
  const std::filesystem::path file = named_file(name, {"rigs"});
  const Json document = load_json<Json>(file, "a calibration study in JSON");
  refuse_other_kinds(document, FileKind::calibration, file.string());
  if (!document.contains("calibrate"))
    throw input_error(file.string(), "calibrate", "is missing, expected a calibration study");
  Reader reader(document, file.string());
  const std::string wanted = reader.text("calibrate");
  const CalibrationKind& kind = entry_named(calibration_kinds(), wanted, [&](const std::string& what) {
    return reader.wrong("calibrate", "'" + wanted + "' " + what);
  });
  std::vector<std::string> keys;
  for (const CalibrationKey& key : calibration_keys())
    if (key.of_every_kind) keys.emplace_back(key.name);
  if (kind.noisy) keys.emplace_back("evaluations");
  keys.insert(keys.end(), kind.keys.begin(), kind.keys.end());
  reader.allow_only(keys);
  reader.check_version(kStudyVersion);
  Calibration c;
  c.file = file;
  c.name = file.stem().string();
  c.description = reader.text_or("description", "");
  c.kind = &kind;
  if (!reader.given("start")) reader.fail("start", "is missing, expected {}", kind.start);
  c.start = find_file(reader.text("start"), "start", file);
  c.parameters = parameters_of(reader, kind);
  const auto count = [&](const char* key, int least, int most, int otherwise) {
    return reader.given(key) ? reader.count(key, least, most) : otherwise;
  };
  c.starts = count("starts", 1, kMostStarts, c.starts);
  c.seed = static_cast<std::uint64_t>(count("seed", 0, kLargestSeed, static_cast<int>(c.seed)));
  if (kind.noisy)
    c.evaluations = count("evaluations", least_evaluations(c.parameters.size()), kMostEvaluations,
                          usual_evaluations(c.parameters.size()));
  c.result = result_name(reader, c);
  CalibrationInput input{
      file, c.start, {}, {targets_of(reader, "targets", 1), targets_of(reader, "held_out", 0)}, reader};
  for (const Parameter& p : c.parameters) input.parameters.push_back(p.name);
  c.model = kind.read(input);
  require_names(reader, *c.model);
  take_starts(c.parameters, *c.model, reader);
  const std::size_t points = points_of(c.model->targets(TargetSet::fitted));
  if (points < c.parameters.size() + (kind.noisy ? 0 : 1)) {
    const std::vector<std::string>& notes = c.model->notes();  // reasons why targets were left out, if any
    reader.fail("targets", "has {} points, expected {} there are parameters, {}{}{}", points,
                kind.noisy ? "as many as" : "more than", c.parameters.size(), notes.empty() ? "" : "; ",
                fmt::join(notes, "; "));
  }
  c.digest = digest_of(c);
  return c;
}

}  // namespace furrow::calibrate
