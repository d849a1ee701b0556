#include "nodes/scenario/load_scenario.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "nodes/scenario/model_keys.hpp"
#include "nodes/scenario/refused_scenario.hpp"
#include "nodes/scenario/rig_tires.hpp"
#include "nodes/scenario/scenario_checks.hpp"
#include "nodes/scenario/schema.hpp"
#include "nodes/scenario/soil_material.hpp"
#include "protocol/core/error.hpp"
#include "protocol/core/hash.hpp"
#include "protocol/files/data_files.hpp"
#include "protocol/files/file_kind.hpp"
#include "protocol/files/json_fields.hpp"
#include "protocol/files/json_text.hpp"
#include "protocol/files/printable.hpp"
#include "protocol/files/text_file.hpp"
#include "protocol/host.hpp"
#include "rigs/rigs.hpp"
#include "terrain/terrain_spec.hpp"
#include "tire/tires.hpp"

namespace furrow::scenario {
namespace {

using nlohmann::json;

constexpr int kFormatVersion = 1;
constexpr std::size_t kMaxKey = 256;           // bytes
constexpr const char* kFriction = "friction";  // of the terrain

std::vector<std::string> split(const std::string& key) {
  std::vector<std::string> parts(1);
  for (const char c : key)
    if (c == '.')
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

/// Names are written into results, which are JSON. `what`: "has a name"
void require_utf8(const std::string& name, const std::string& file, const std::string& key, const char* what) {
  if (find_invalid_utf8(name) != std::string::npos)
    throw input_error(file, key, std::string(what) + " that is not UTF-8, expected one that is: results keep it");
}

/// Puts the value of `--set key=value` into the document and makes missing sections.
void set_value(json& document, const std::string& key, const std::string& text, const std::string& file) {
  const std::vector<std::string> parts = split(key);
  if (std::find(parts.begin(), parts.end(), "") != parts.end() || parts.size() >= kMaxDepth ||
      excerpt(key, kMaxKey) != key)
    throw input_error(file, excerpt(key), "is not a key, expected --set section.key=value");
  const json value = parse_value(text, file, key);
  json* at = &document;
  for (const std::string& part : parts) {
    if (at->is_null()) *at = json::object();
    if (at->is_array()) {
      const bool index =
          part.size() < 4 && std::all_of(part.begin(), part.end(), [](unsigned char c) { return std::isdigit(c); });
      if (!index || std::stoul(part) >= at->size())
        throw input_error(file, key, "there is no entry '{}', expected 0 to {}", part,
                          static_cast<int>(at->size()) - 1);
      at = &(*at)[std::stoul(part)];
    } else if (at->is_object()) {
      at = &(*at)[part];
    } else {
      throw input_error(file, key, "there is nothing below {}, expected a section before '.{}'", value_text(*at), part);
    }
  }
  *at = value;
}

/// Refuses keys of a vehicle's file, which are not the scenario's; the message explains how to change them.
void refuse_vehicle_key(const json& document, const std::string& key, const std::string& file) {
  std::string within = key;
  for (const char* prefix : {"rig.vehicle.", "vehicle."})
    if (key.starts_with(prefix)) within = key.substr(std::string(prefix).size());
  const std::string top = within.substr(0, within.find_first_of(".["));
  if (within == key && top != "chassis" && top != "axles" && top != "driveline") return;
  const json rig = document.value("rig", json());
  const json name = rig.is_object() ? rig.value("vehicle", json()) : json();
  const std::string of = name.is_string() ? "'" + name.get<std::string>() + "'" : "the vehicle's file";
  throw input_error(file, key,
                    "is a key of {}, which --set does not reach, expected a copy of that file with another '{}', and "
                    "--set rig.vehicle=COPY",
                    of, within);
}

Error all_problems(const std::string& file, const std::vector<Problem>& problems) {
  std::string text;
  for (const Problem& problem : problems)
    text += (text.empty() ? "" : "\n") + std::string(input_error(file, problem.key, problem.what).what());
  return Error(ExitCode::bad_input, text);
}

/// The engine of the scenario after all settings.
std::string engine_to_be(json document, const std::string& file, const Settings& settings) {
  for (const auto& [key, text] : settings)
    if (key == "terrain.engine") set_value(document, key, text, file);
  const json terrain = document.value("terrain", json());
  const json engine = terrain.is_object() ? terrain.value("engine", json()) : json();
  return engine.is_string() ? engine.get<std::string>() : terrain::CommonOptions().engine;
}

json read_document(const std::string& file, const Settings& settings) {
  json document = parse_json(read_text_file(file, "a scenario in JSON"), file);
  if (!document.is_object()) throw input_error(file, "", "is " + value_text(document) + ", expected an object { }");
  refuse_other_kinds(document, FileKind::scenario, file);
  // A soil on the command line replaces the file's own values of soil, but none that is set beside it.
  const std::string soil = "terrain.material", engine = engine_to_be(document, file, settings);
  if (std::none_of(settings.begin(), settings.end(), [&](const auto& one) { return one.first == soil; }))
    apply_soil_material(document, file, engine);
  for (const auto& [key, text] : settings) {
    refuse_vehicle_key(document, key, file);
    if (key.starts_with("tires.") && !document.contains("tires")) fill_rig_tires(document, file);
    set_value(document, key, text, file);
    if (key == soil) override_soil_material(document, file, engine, settings);
  }
  if (document.contains("format_version") && document["format_version"].is_number_integer() &&
      document["format_version"] > kFormatVersion)
    throw input_error(file, "format_version", "is {}: the file is newer than this program, expected at most {}",
                      value_text(document["format_version"]), kFormatVersion);
  if (document.contains("vehicle"))
    throw input_error(file, "vehicle", "is not a section, expected rig.vehicle beside rig.type 'vehicle'");
  return document;
}

/// Returns warnings of keys that were set aside. @param friction of the ground, if it is stated
std::vector<std::string> complete(json& document, const std::string& file, const Settings& settings,
                                  std::optional<double>& friction) {
  const Schema& schema = Schema::of_scenarios();
  fill_rig_tires(document, file);
  schema.normalize(document);
  if (const auto problems = schema.problems(document); !problems.empty()) throw all_problems(file, problems);
  if (document.contains("tire") && document.contains("tires"))
    throw input_error(file, "tires", "is given beside 'tire', expected one of the two");
  if (!document.contains("tire") && !document.contains("tires"))
    throw input_error(file, "tire", "is missing, expected an object { } with the tire's file");
  std::vector<std::string> set_aside = set_aside_keys(document, schema, file, settings);
  if (const std::string partial = partial_soil_warning(document, file); !partial.empty()) set_aside.push_back(partial);
  if (const json& terrain = document.at("terrain"); terrain.contains(kFriction)) friction = terrain[kFriction];
  schema.fill_defaults(document);
  schema.normalize(document);
  remove_foreign_keys(document);
  return set_aside;
}

/// Returns the rig, so that its starts can be filled in.
std::shared_ptr<rigs::RigSpec> take_rig(const json& j, Scenario& s) {
  rigs::RigOptions options;
  read_fields(j, options);
  s.rig_substeps = options.substeps;
  s.drop_height = options.drop_height;
  std::shared_ptr<rigs::RigSpec> rig = rigs::read_rig(j, {s.file.string(), "rig"});
  s.rig = rig;
  return rig;
}

void take_tires(const json& document, Scenario& s) {
  s.tires_listed = document.contains("tires");
  if (document.contains("tire"))
    s.tires.assign(s.rig->wheel_count(), tire::read_tire(document["tire"], {s.file.string(), "tire"}));
  else
    for (std::size_t k = 0; k < document["tires"].size(); ++k) {
      const json& section = document["tires"][k];
      const bool as_before = k > 0 && section == document["tires"][k - 1];
      s.tires.push_back(as_before ? s.tires.back()
                                  : tire::read_tire(section, {s.file.string(), fmt::format("tires.{}", k)}));
    }
  s.tire_substeps = s.tires.front()->options().substeps;
  for (std::size_t k = 0; k < s.tires.size(); ++k) {
    const tire::TireOptions& tire = s.tires[k]->options();
    if (tire.substeps != s.tire_substeps)
      throw input_error(s.file.string(), fmt::format("tires.{}.substeps", k),
                        "is {}, expected {} as for the first tire", tire.substeps, s.tire_substeps);
  }
}

void take_run(json j, Scenario& s) {
  if (j["threads"].is_string()) j["threads"] = 0;  // auto
  read_fields(j, s.run);
}

/// While the bed settles the other ranks wait, but the terrain may be bound to its own cores.
int settle_threads(int wanted) {
  if (wanted > 0) return wanted;
  const int cores = static_cast<int>(allowed_cores().size());
  const int of_others = cores < 4 ? 0 : cores < 8 ? 1 : 2;
  return std::clamp(cores - of_others, 1, 32);
}

void take_terrain(const json& j, Scenario& s) {
  const ReadContext context{s.file.string(), "terrain"};
  terrain::CommonOptions common;
  read_fields(j, common);
  s.terrain_ranks = common.ranks;
  s.terrain_substeps = common.substeps;
  s.settle_threads = settle_threads(s.run.threads);
  s.terrain = terrain::find_terrain(common.engine, context).read(j, context);
}

// Keys outside the sections that only users and editors read.
constexpr const char* kCompletedBy = "completed_by";
constexpr std::array<const char*, 3> kRemarks{"description", "$schema", kCompletedBy};

/// Keys that change no result, by the structs' lists of fields; with their sections.
const std::vector<std::string>& harmless_keys() {
  static const std::vector<std::string> keys = [] {
    std::vector<std::string> all{kRemarks.begin(), kRemarks.end()};
    const auto add = [&](const std::string& section, const std::vector<std::string>& names) {
      for (const std::string& name : names) all.push_back(section + "." + name);
    };
    constexpr unsigned kRoles = role::key | role::harmless;
    add("run", field_names<RunOptions>(kRoles));
    add("checkpoint", field_names<CheckpointOptions>(kRoles));
    add("press", field_names<PressKeys>(kRoles));
    add("expected", field_names<ExpectedResult>(kRoles));
    add("terrain", terrain::terrain_keys(role::harmless));
    return all;
  }();
  return keys;
}

bool is_harmless(const std::string& key) {
  return std::find(harmless_keys().begin(), harmless_keys().end(), key) != harmless_keys().end();
}

/// The output intervals are part of the digest, but do not affect the physics.
bool is_output(const std::string& key) { return key.starts_with("output."); }

/// The expected result holds for the scenario as shipped; a setting that changes the physics invalidates it.
bool changes_results(const std::string& key) {
  const bool section = key == "expected" || key == "press" || key == "checkpoint" || key == "output";
  return !section && !is_harmless(key) && !is_output(key);
}

/// Removes the value at the dotted key, and its section if it is then empty.
void erase(json& document, const std::string& key) {
  const std::size_t dot = key.find('.');
  const auto section = document.find(key.substr(0, dot));
  if (section == document.end()) return;
  if (dot != std::string::npos) section->erase(key.substr(dot + 1));
  if (dot == std::string::npos || section->empty()) document.erase(section);
}

// Increased when a default changes: scenarios without the key then have another meaning.
constexpr int kDigestVersion = 2;

/// Only values that differ from the default count, by name. A key that is added later thus does not change the digest
/// of scenarios without it.
std::string digest_of(json completed, const Scenario& s) {
  for (const std::string& key : harmless_keys()) erase(completed, key);
  erase(completed, std::string("terrain.") + kSoilKey);  // its values are in the other keys
  // Files count by their content, at any place.
  for (const rigs::RigFile& file : s.rig->files()) completed["rig"].erase(file.key);
  for (const terrain::TerrainFile& file : s.terrain->files()) completed["terrain"].erase(file.key);
  if (completed.contains("tire")) completed["tire"].erase("file");
  if (completed.contains("tires"))
    for (json& tire : completed["tires"]) tire.erase("file");
  Schema::of_scenarios().remove_defaults(completed);
  // For a tire with a contact of its own, the stated default differs from no value.
  if (s.ground_friction && s.has_own_contact()) completed["terrain"][kFriction] = *s.ground_friction;
  Hash hash;
  hash.add(&kDigestVersion, sizeof kDigestVersion);
  hash.add(completed.dump());
  for (const std::string& file : s.file_hashes()) hash.add(file);
  return hash.hex();
}

/// Gives files next to the scenario their full names; those of the data folders are found from anywhere.
void make_movable(json& document, const Scenario& s) {
  const auto full = [&](json& name, const std::string& key) {
    std::error_code error;
    if (!name.is_string() || std::filesystem::path(name.get<std::string>()).is_absolute()) return;
    const std::filesystem::path beside = s.file.parent_path() / name.get<std::string>();
    if (!std::filesystem::is_regular_file(beside, error)) return;
    const std::string whole = std::filesystem::absolute(beside, error).lexically_normal().string();
    require_utf8(whole, s.file.string(), key, "is in a folder with a name");
    name = whole;
  };
  for (const terrain::TerrainFile& file : s.terrain->files())
    full(document["terrain"][file.key], std::string("terrain.") + file.key);
  for (const rigs::RigFile& file : s.rig->files()) full(document["rig"][file.key], "rig." + file.key);
  if (document["terrain"].contains(kSoilKey)) full(document["terrain"][kSoilKey], std::string("terrain.") + kSoilKey);
  if (document.contains("tire")) full(document["tire"]["file"], "tire.file");
  if (document.contains("tires"))
    for (std::size_t k = 0; k < document["tires"].size(); ++k)
      full(document["tires"][k]["file"], fmt::format("tires.{}.file", k));
}

}  // namespace

Scenario load_scenario(const std::filesystem::path& name, const Settings& settings, Purpose purpose) {
  // A vehicle's name is found too, and then refused with its own message.
  const std::filesystem::path file = named_file(name, {"rigs", "vehicle/data"});
  Scenario s;
  s.file = file;
  s.name = file.stem().string();
  require_utf8(s.name, file.string(), "", "has a name");
  json document = read_document(file.string(), settings);
  s.warnings = complete(document, file.string(), settings, s.ground_friction);
  fill_cone_index(document, file);
  for (const std::string& warning :
       {kept_cone_index_warning(document, file, settings), other_grains_warning(document, file)})
    if (!warning.empty()) s.warnings.push_back(warning);
  take_run(document["run"], s);
  read_fields(document["output"], s.output);
  read_fields(document["checkpoint"], s.checkpoint);
  if (document.contains("press")) read_fields(document["press"], s.press);
  std::vector<std::string> unusual;
  for (const Problem& problem : Schema::of_scenarios().unusual(document))
    unusual.emplace_back(input_error(file.string(), problem.key, problem.what).what());
  s.warnings.insert(s.warnings.end(), unusual.begin(), unusual.end());
  try {
    const std::shared_ptr<rigs::RigSpec> rig = take_rig(document["rig"], s);
    take_tires(document, s);
    take_terrain(document["terrain"], s);
    check_scenario(s, *rig, purpose);
    rig->complete(document["rig"]);
  } catch (const Error& error) {  // an unlikely value may be the cause
    throw RefusedScenario(error, unusual);
  }
  if (document.contains("expected")) {
    read_fields(document["expected"], s.expected);
    s.expected.given = std::none_of(settings.begin(), settings.end(),
                                    [](const auto& setting) { return changes_results(setting.first); });
  }
  s.digest = digest_of(document, s);
  make_movable(document, s);
  if (!s.ground_friction && s.has_own_contact()) document["terrain"].erase(kFriction);
  document[kCompletedBy] = std::string("furrow ") + FURROW_VERSION;
  s.completed = document.dump(2);
  return s;
}

bool may_change_on_resume(const std::string& key) {
  if (key == "output.series_interval") return false;  // means count the lines of a series equally
  return is_harmless(key) || is_output(key) || key == "run.end" || key == "run.average_from";
}

bool steps_finer(const std::string& key) {
  return key == "run.step" || key == "terrain.substeps" || key == "tire.substeps" || key == "rig.substeps";
}

}  // namespace furrow::scenario
