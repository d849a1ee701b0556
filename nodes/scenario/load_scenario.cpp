#include "nodes/scenario/load_scenario.hpp"

#include <unistd.h>
#include <climits>
#include <cmath>
#include <cstdlib>

#include <algorithm>
#include <fstream>
#include <iterator>

#include <fmt/format.h>

#include "nodes/scenario/scenario_checks.hpp"
#include "nodes/scenario/schema.hpp"
#include "nodes/scenario/soil_material.hpp"
#include "protocol/core/error.hpp"
#include "protocol/core/hash.hpp"
#include "protocol/files/data_files.hpp"
#include "protocol/files/json_text.hpp"
#include "protocol/files/text_file.hpp"
#include "protocol/host.hpp"

namespace furrow::scenario {
namespace {

using nlohmann::json;
using Settings = std::vector<std::pair<std::string, std::string>>;

constexpr int kFormatVersion = 1;

std::vector<std::string> split(const std::string& key) {
  std::vector<std::string> parts(1);
  for (const char c : key)
    if (c == '.')
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

/// Puts the value of `--set key=value` into the document, making sections that it lacks.
void set_value(json& document, const std::string& key, const std::string& text, const std::string& file) {
  const std::vector<std::string> parts = split(key);
  if (std::find(parts.begin(), parts.end(), "") != parts.end())
    throw input_error(file, key, "is no key, expected --set section.key=value");
  const json value = parse_value(text, file, key);
  json* at = &document;
  for (const std::string& part : parts) {
    if (at->is_null()) *at = json::object();
    if (at->is_array()) {
      const bool index = part.size() < 4 && std::all_of(part.begin(), part.end(),
                                                        [](unsigned char c) { return std::isdigit(c); });
      if (!index || std::stoul(part) >= at->size())
        throw input_error(
            file, key,
            fmt::format("there is no entry '{}', expected 0 to {}", part, static_cast<int>(at->size()) - 1));
      at = &(*at)[std::stoul(part)];
    } else if (at->is_object()) {
      at = &(*at)[part];
    } else {
      throw input_error(
          file, key,
          fmt::format("there is nothing below {}, expected a section before '.{}'", value_text(*at), part));
    }
  }
  *at = value;
}

Error all_problems(const std::string& file, const std::vector<Problem>& problems) {
  std::string text;
  for (const Problem& problem : problems)
    text += (text.empty() ? "" : "\n") + std::string(input_error(file, problem.key, problem.what).what());
  return Error(ExitCode::bad_input, text);
}

json read_document(const std::string& file, const Settings& settings) {
  json document = parse_json(read_text_file(file, "a scenario in JSON"), file);
  if (!document.is_object())
    throw input_error(file, "", "is " + value_text(document) + ", expected an object { }");
  if (document.contains("scenario"))
    throw input_error(file, "", "is a study, expected a scenario ('furrow sweep' takes studies)");
  // What is said later wins: a soil of the command line replaces what the file says of its soil.
  const std::string soil = "terrain.material";
  if (std::none_of(settings.begin(), settings.end(), [&](const auto& one) { return one.first == soil; }))
    apply_soil_material(document, file);
  for (const auto& [key, text] : settings) {
    set_value(document, key, text, file);
    if (key == soil) override_soil_material(document, file);
  }
  if (document.contains("format_version") && document["format_version"].is_number_integer() &&
      document["format_version"] > kFormatVersion)
    throw input_error(file, "format_version",
                      fmt::format("is {}: the file is newer than this program, expected at most {}",
                                  value_text(document["format_version"]), kFormatVersion));
  if (document.contains("vehicle"))
    throw input_error(file, "vehicle", "whole vehicles are not available in this version, expected 'rig'");
  return document;
}

void complete(json& document, const std::string& file) {
  const Schema schema = Schema::load();
  schema.normalize(document);
  if (const auto problems = schema.problems(document); !problems.empty()) throw all_problems(file, problems);
  if (document.contains("tire") && document.contains("tires"))
    throw input_error(file, "tires", "is given beside 'tire', expected one of the two");
  if (!document.contains("tire") && !document.contains("tires"))
    throw input_error(file, "tire", "is missing, expected an object { } with the tire's file");
  schema.fill_defaults(document);
  schema.normalize(document);
}

double number_or(const json& value, double absent) { return value.is_null() ? absent : value.get<double>(); }
int count_or(const json& value, int absent) { return value.is_null() ? absent : value.get<int>(); }

rigs::DrawbarRigOptions rig_options(const json& j) {
  rigs::DrawbarRigOptions o;
  o.mode = j["mode"];
  o.slip = j["slip"];
  o.angular_speed = j["angular_speed"];
  o.speed = j["speed"];
  o.ramp = j["ramp"];
  o.touchdown_damping = j["touchdown_damping"];
  o.touchdown_time = j["touchdown_time"];
  o.toe_angle = j["toe_angle"];
  o.toe_time = j["toe_time"];
  o.toe_ramp = j["toe_ramp"];
  o.camber_angle = j["camber_angle"];
  o.travel_sign = j["travel_sign"];
  o.start = number_or(j["start"], 0.0);
  o.carrier_mass = j["carrier_mass"];
  o.chassis_mass = j["chassis_mass"];
  o.set_toe_mass = j["set_toe_mass"];
  o.rim_mass = j["rim_mass"];
  o.rim_spin_inertia = j["rim_spin_inertia"];
  o.rim_diametral_inertia = j["rim_diametral_inertia"];
  return o;
}

void take_rig(const json& j, Scenario& s) {
  s.rigs = {rig_options(j)};
  s.rig_substeps = j["substeps"];
  s.drop_height = j["drop_height"];
  if (j["wheels"].empty()) return;
  s.rigs.assign(j["wheels"].size(), s.rigs.front());
  for (std::size_t k = 0; k < s.rigs.size(); ++k) {
    const json& wheel = j["wheels"][k];
    rigs::DrawbarRigOptions& o = s.rigs[k];
    o.lateral = wheel["lateral"];
    o.slip = number_or(wheel["slip"], o.slip);
    o.toe_angle = number_or(wheel["toe_angle"], o.toe_angle);
    o.camber_angle = number_or(wheel["camber_angle"], o.camber_angle);
    o.start = number_or(wheel["start"], o.start);
    o.carrier_mass = number_or(wheel["carrier_mass"], o.carrier_mass);
  }
}

/// A number is one knot, null none.
tire::PressureSchedule pressure_schedule(const json& value, const std::string& key, const std::string& file) {
  tire::PressureSchedule schedule;
  if (value.is_number()) schedule.knots = {{0.0, value.get<double>()}};
  if (!value.is_array()) return schedule;
  for (const json& entry : value) {
    const tire::PressureSchedule::Knot knot{entry[0].get<double>(), entry[1].get<double>()};
    const std::string here = fmt::format("{}.{}", key, schedule.knots.size());
    if (knot.pressure < 0.0)
      throw input_error(file, here + ".1",
                        fmt::format("is {} Pa, expected 0 or more", number_text(knot.pressure)));
    if (!schedule.empty() && !(knot.time > schedule.knots.back().time))
      throw input_error(file, here + ".0",
                        fmt::format("is {} s, expected a time after that of the entry before, {} s",
                                    number_text(knot.time), number_text(schedule.knots.back().time)));
    schedule.knots.push_back(knot);
  }
  return schedule;
}

void take_tire(const json& j, const std::string& key, Scenario& s) {
  tire::TireOptions o;
  o.file = find_file(j["file"], key + ".file", s.file);
  o.pressure = pressure_schedule(j["pressure"], key + ".pressure", s.file.string());
  o.friction = number_or(j["friction"], -1.0);
  o.elements_circumference = count_or(j["elements_circumference"], 0);
  o.elements_width = count_or(j["elements_width"], 0);
  o.structural_damping = number_or(j["structural_damping"], -1.0);
  o.rigid = j["rigid"];
  o.contact_tangent = j["contact_tangent"];
  const int substeps = j["substeps"];
  if (!s.tires.empty() && substeps != s.tire_substeps)
    throw input_error(s.file.string(), key + ".substeps",
                      fmt::format("is {}, expected {} as for the first tire", substeps, s.tire_substeps));
  s.tire_substeps = substeps;
  o.substep = s.run.step / substeps;
  s.tires.push_back(o);
}

void take_run(const json& j, const json& output, Scenario& s) {
  s.run.step = j["step"];
  s.run.end = j["end"];
  s.run.average_from = j["average_from"];
  s.run.threads = j["threads"].is_string() ? 0 : j["threads"].get<int>();
  s.run.seed = j["seed"];
  s.run.peer_timeout = j["peer_timeout"];
  s.output.series_interval = output["series_interval"];
  s.output.frame_interval = output["frame_interval"];
}

void take_checkpoint(const json& j, Scenario& s) {
  s.checkpoint.wall_interval = j["wall_interval"];
  s.checkpoint.interval = j["interval"];
  s.checkpoint.keep = j["keep"];
  s.checkpoint.at_end = j["at_end"];
}

/// While the bed settles the other ranks wait, but the terrain may be bound to its own cores.
int settle_threads(int wanted) {
  if (wanted > 0) return wanted;
  const int cores = static_cast<int>(allowed_cores().size());
  const int of_others = cores < 4 ? 0 : cores < 8 ? 1 : 2;
  return std::clamp(cores - of_others, 1, 32);
}

void take_terrain(const json& j, Scenario& s) {
  terrain::TerrainOptions& o = s.terrain;
  o.scenario = s.file.string();
  o.engine = j["engine"];
  o.law = j["law"];
  o.radius = j["radius"];
  o.size_distribution = j["size_distribution"];
  o.size_spread = j["size_spread"];
  o.density = j["density"];
  o.layers = j["layers"];
  o.length = j["length"];
  o.width = j["width"];
  o.periodic_y = j["sides"] == "periodic";
  o.seed = s.run.seed;
  if (j["bed"].is_string()) o.bed = find_file(j["bed"], "terrain.bed", s.file).string();
  o.bed_generator = j["bed_generator"];
  o.undisturbed_height = number_or(j["undisturbed_height"], -1.0);
  o.compaction_pressure = j["compaction_pressure"];
  o.settling_friction = number_or(j["settling_friction"], -1.0);
  o.cache = j["cache"];
  o.young_modulus = j["young_modulus"];
  o.poisson_ratio = j["poisson_ratio"];
  o.restitution = j["restitution"];
  o.friction = j["friction"];
  o.rolling_friction = j["rolling_friction"];
  o.cohesion = j["cohesion"];
  o.normal_stiffness = j["normal_stiffness"];
  o.normal_damping = j["normal_damping"];
  o.friction_velocity_scale = j["friction_velocity_scale"];
  o.friction_impulse_limit = j["friction_impulse_limit"];
  o.activity = j["activity"];
  o.precision = j["precision"];
  o.ground_stiffness = j["ground_stiffness"];
  o.ground_damping = j["ground_damping"];
  o.ground_shear_stiffness = j["ground_shear_stiffness"];
  o.allow_unstable_step = j["allow_unstable_step"];
  o.settle_threads = settle_threads(s.run.threads);
  s.terrain_ranks = j["ranks"];
  s.terrain_substeps = j["substeps"];
  o.step = s.run.step / s.terrain_substeps;
}

/// The expected result holds for the scenario as shipped; a setting that changes the physics makes it void.
bool changes_results(const std::string& key) {
  for (const char* harmless :
       {"run.threads", "run.peer_timeout", "output.", "checkpoint.", "expected", "description", "$schema"})
    if (key.starts_with(harmless)) return false;
  return true;
}

std::string digest_of(json completed, const Scenario& s) {
  for (const char* harmless : {"description", "$schema", "expected", "checkpoint"}) completed.erase(harmless);
  for (const char* harmless : {"threads", "peer_timeout"}) completed["run"].erase(harmless);
  completed["terrain"].erase("cache");
  // Files count by what they hold, wherever they stand.
  completed["terrain"].erase("bed");
  if (completed.contains("tire")) completed["tire"].erase("file");
  if (completed.contains("tires"))
    for (json& tire : completed["tires"]) tire.erase("file");
  Hash hash;
  hash.add(completed.dump());
  for (const std::string& file : s.file_hashes()) hash.add(file);
  return hash.hex();
}

/// Files that stand beside the scenario get their full names; those of the data folders are found from anywhere.
void make_movable(json& document, const Scenario& s) {
  const auto full = [&](json& name) {
    std::error_code error;
    if (!name.is_string() || std::filesystem::path(name.get<std::string>()).is_absolute()) return;
    const std::filesystem::path beside = s.file.parent_path() / name.get<std::string>();
    if (std::filesystem::is_regular_file(beside, error))
      name = std::filesystem::absolute(beside, error).lexically_normal().string();
  };
  full(document["terrain"]["bed"]);
  if (document.contains("tire")) full(document["tire"]["file"]);
  if (document.contains("tires"))
    for (json& tire : document["tires"]) full(tire["file"]);
}

}  // namespace

Scenario load_scenario(const std::filesystem::path& file, const Settings& settings) {
  Scenario s;
  s.file = file;
  s.name = file.stem().string();
  json document = read_document(file.string(), settings);
  complete(document, file.string());
  take_run(document["run"], document["output"], s);
  take_checkpoint(document["checkpoint"], s);
  take_rig(document["rig"], s);
  if (document.contains("tire"))
    for (std::size_t k = 0; k < s.rigs.size(); ++k) take_tire(document["tire"], "tire", s);
  else
    for (std::size_t k = 0; k < document["tires"].size(); ++k)
      take_tire(document["tires"][k], fmt::format("tires.{}", k), s);
  take_terrain(document["terrain"], s);
  for (const tire::TireOptions& tire : s.tires) s.terrain.contact_tangents |= tire.contact_tangent;
  if (document.contains("expected")) {
    s.expected.drawbar_pull = document["expected"]["drawbar_pull"];
    s.expected.drawbar_pull_spread = document["expected"]["drawbar_pull_spread"];
    s.expected.given = std::none_of(settings.begin(), settings.end(),
                                    [](const auto& setting) { return changes_results(setting.first); });
  }
  for (const Problem& problem : Schema::load().unusual(document))
    s.warnings.push_back(input_error(file.string(), problem.key, problem.what).what());
  std::vector<bool> default_start(s.rigs.size(), document["rig"]["start"].is_null());
  for (std::size_t k = 0; k < document["rig"]["wheels"].size(); ++k)
    default_start[k] = default_start[k] && document["rig"]["wheels"][k]["start"].is_null();
  const std::vector<std::string> unusual = s.warnings;
  try {
    check_scenario(s, default_start);
  } catch (const Error& error) {  // what looks wrong may be why it does not fit
    std::string text = error.what();
    for (const std::string& warning : unusual) text += "\n" + warning;
    throw Error(error.code(), text);
  }
  document["rig"]["start"] = s.rigs.front().start;
  for (std::size_t k = 0; k < document["rig"]["wheels"].size(); ++k)
    document["rig"]["wheels"][k]["start"] = s.rigs[k].start;
  s.digest = digest_of(document, s);
  make_movable(document, s);
  s.completed = document.dump(2);
  return s;
}

bool may_change_on_resume(const std::string& key) {
  for (const char* section : {"output.", "checkpoint.", "expected."})
    if (key.starts_with(section)) return true;
  for (const char* name : {"run.end", "run.average_from", "run.threads", "run.peer_timeout", "terrain.cache",
                           "description", "$schema"})
    if (key == name) return true;
  return false;
}

}  // namespace furrow::scenario
