#include "nodes/calibrate/study.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "nodes/calibrate/budget.hpp"
#include "nodes/calibrate/explain.hpp"
#include "protocol/core/error.hpp"
#include "protocol/core/hash.hpp"
#include "protocol/files/data_files.hpp"
#include "protocol/files/file_kind.hpp"
#include "protocol/files/json_text.hpp"
#include "protocol/files/nearest_words.hpp"
#include "protocol/files/text_file.hpp"

namespace furrow::calibrate {
namespace {

using Json = nlohmann::ordered_json;
using Reader = OrderedJsonReader;

constexpr int kFormatVersion = 1;
constexpr int kMostEvaluations = 1000, kMostStarts = 1000, kMostTargets = 1000, kLargestSeed = 2147483647;
/// Names that results of a calibration have.
constexpr const char* kTaken[] = {"calibration.json", "sweep.json", "summary.json", "scenario.json"};

const CalibrationKind& kind_of(Reader& reader) {
  const std::string name = reader.text("calibrate");
  std::vector<std::string> known;
  for (const CalibrationKind& kind : calibration_kinds()) {
    if (kind.name == name) return kind;
    known.emplace_back(kind.name);
  }
  reader.fail("calibrate", "'" + name + "' " + unknown_text(nearest_words(name, known), known));
}

const ParameterRule& rule_of(Reader& reader, const CalibrationKind& kind, const std::string& name) {
  std::vector<std::string> known;
  for (const ParameterRule& rule : kind.parameters()) {
    if (rule.name == name) return rule;
    known.push_back(rule.name);
  }
  reader.fail("parameters." + name, unknown_text(nearest_words(name, known), known));
}

bool is_logarithmic(Reader& reader, const ParameterRule& rule) {
  const std::string scale = reader.text_or("scale", rule.logarithmic ? "log" : "linear");
  if (scale != "log" && scale != "linear") reader.fail("scale", "is '" + scale + "', expected 'log' or 'linear'");
  return scale == "log";
}

/// Name, bounds and scale; `start` is NaN where the study gives none.
Parameter parameter_of(Reader reader, const ParameterRule& rule) {
  Parameter p{rule.name, rule.unit, rule.lower, rule.upper, NAN, is_logarithmic(reader, rule)};
  const auto bound = [&](const char* key, double& value) {
    reader.skip(key);
    if (reader.has(key)) value = reader.number(key);
    if (value < rule.least || value > rule.most)
      reader.fail(key, fmt::format("is {}, expected {} to {} {}", number_text(value), number_text(rule.least),
                                   number_text(rule.most), rule.unit));
  };
  bound("lower", p.lower), bound("upper", p.upper);
  reader.skip("start");
  if (reader.has("start")) {
    p.start = reader.number("start");
    if (!(p.start >= p.lower && p.start <= p.upper))
      reader.fail("start", fmt::format("is {}, expected a value from lower to upper, {} to {} {}", number_text(p.start),
                                       number_text(p.lower), number_text(p.upper), p.unit));
  }
  if (!(p.lower < p.upper))
    reader.fail("upper",
                fmt::format("is {}, expected more than lower, {}", number_text(p.upper), number_text(p.lower)));
  if (p.logarithmic && !(p.lower > 0.0))
    reader.fail("lower", fmt::format("is {}, expected above 0 for the scale 'log'", number_text(p.lower)));
  reader.finish();
  return p;
}

std::vector<Parameter> parameters_of(Reader& reader, const CalibrationKind& kind) {
  const Json& all = reader.object().at("parameters");
  std::vector<Parameter> parameters;
  for (const auto& [name, value] : all.items()) {
    const std::string path = "parameters." + name;
    if (!value.is_object())
      reader.fail(path, "is " + value_text(value) + ", expected an object { } with lower, upper, start, scale");
    parameters.push_back(parameter_of(Reader(value, reader.file(), path), rule_of(reader, kind, name)));
  }
  if (parameters.empty()) reader.fail("parameters", "is empty, expected one parameter or more");
  return parameters;
}

std::vector<Reader> targets_of(Reader& reader, const std::string& key, bool required) {
  if (!required && !reader.given(key)) {
    reader.skip(key);
    return {};
  }
  const Json& list = reader.array(key);
  if ((required && list.empty()) || list.size() > kMostTargets)
    reader.fail(key, fmt::format("has {} entries, expected {} to {}", list.size(), required ? 1 : 0, kMostTargets));
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
  std::vector<std::string> names;
  for (const TargetSet set : {TargetSet::fitted, TargetSet::held_out})
    for (const Target& target : model.targets(set)) {
      if (std::find(names.begin(), names.end(), target.name) != names.end())
        reader.fail(std::string(set == TargetSet::fitted ? "targets" : "held_out"),
                    "has the name '" + target.name + "' twice in this study, expected another 'name' for one of them");
      names.push_back(target.name);
    }
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
      reader.fail(
          "parameters." + p.name,
          fmt::format(
              "begins at {} {}, which is the start file's, expected bounds around it or a 'start' within {} to {}",
              number_text(p.start), p.unit, number_text(p.lower), number_text(p.upper)));
  }
}

int evaluations_of(Reader& reader, std::size_t parameters) {
  const int least = least_evaluations(parameters);
  return reader.given("evaluations") ? reader.count("evaluations", least, kMostEvaluations)
                                     : usual_evaluations(parameters);
}

std::string result_name(Reader& reader, const Calibration& c) {
  const std::string name = reader.text_or("result", c.start.stem().string() + "_fitted.json");
  const bool taken = std::find(std::begin(kTaken), std::end(kTaken), name) != std::end(kTaken);
  if (taken || std::filesystem::path(name).filename() != name || !name.ends_with(".json") || name[0] == '.')
    reader.fail("result", "is '" + name + "', expected the name of a .json file without a folder, " +
                              (taken ? "not that of another result" : "which is written into the folder of results"));
  return name;
}

/// Bounds, starts and held-out targets are left out: they may change while evaluations stay.
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
  const CalibrationKind& kind = kind_of(reader);
  std::vector<std::string> keys;
  for (const CalibrationKey& key : calibration_keys())
    if (key.of_every_kind) keys.emplace_back(key.name);
  if (kind.noisy) keys.emplace_back("evaluations");
  keys.insert(keys.end(), kind.keys.begin(), kind.keys.end());
  reader.allow_only(keys);
  reader.check_version(kFormatVersion);
  Calibration c;
  c.file = file;
  c.name = file.stem().string();
  c.description = reader.text_or("description", "");
  c.kind = &kind;
  if (!reader.given("start")) reader.fail("start", fmt::format("is missing, expected {}", c.kind->start));
  c.start = find_file(reader.text("start"), "start", file);
  (void)reader.child("parameters");
  c.parameters = parameters_of(reader, *c.kind);
  c.starts = reader.given("starts") ? reader.count("starts", 1, kMostStarts) : c.starts;
  c.seed = reader.given("seed") ? static_cast<std::uint64_t>(reader.count("seed", 0, kLargestSeed)) : c.seed;
  if (kind.noisy) c.evaluations = evaluations_of(reader, c.parameters.size());
  c.result = result_name(reader, c);
  CalibrationInput input{file,  c.start, {}, targets_of(reader, "targets", true), targets_of(reader, "held_out", false),
                         reader};
  for (const Parameter& p : c.parameters) input.parameters.push_back(p.name);
  c.model = c.kind->read(input);
  require_names(reader, *c.model);
  take_starts(c.parameters, *c.model, reader);
  std::size_t points = 0;
  for (const Target& target : c.model->targets(TargetSet::fitted)) points += target.y.size();
  if (points < c.parameters.size() || (points == c.parameters.size() && !kind.noisy)) {
    const std::vector<std::string> notes = c.model->notes();  // why a target was left out, where one was
    reader.fail("targets", fmt::format("has {} points, expected {} there are parameters, {}{}{}", points,
                                       kind.noisy ? "as many as" : "more than", c.parameters.size(),
                                       notes.empty() ? "" : "; ", fmt::join(notes, "; ")));
  }
  c.digest = digest_of(c);
  return c;
}

}  // namespace furrow::calibrate
