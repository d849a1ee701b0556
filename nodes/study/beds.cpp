#include "nodes/study/beds.hpp"

#include <array>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "nodes/checkpoint/run_summary.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/core/student_t.hpp"
#include "protocol/files/json_number.hpp"
#include "protocol/files/json_text.hpp"
#include "protocol/files/text_file.hpp"
#include "terrain/dem/dem_options.hpp"

namespace furrow::study {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using checkpoint::value_at;

constexpr std::uint64_t kLargestSeed = 9007199254740991;  // of run.seed

/// A figure that is averaged over beds, and its place in a bed's summary.
struct Figure {
  const char* name;
  const char* place;
};
constexpr std::array<Figure, 10> kFigures{{{"drawbar_pull_N", "drawbar_pull_N.mean"},
                                           {"drawbar_coefficient", "drawbar_coefficient"},
                                           {"sinkage_m", "sinkage_m"},
                                           {"rut_depth_m", "rut_depth_m"},
                                           {"rut_width_m", "rut_width_m"},
                                           {"tire_deflection_m", "tire_deflection_m"},
                                           {"tractive_effort_N", "tractive_effort_N"},
                                           {"terrain_resistance_N", "terrain_resistance_N"},
                                           {"drive_torque_Nm", "drive_torque_Nm"},
                                           {"tractive_efficiency", "tractive_efficiency"}}};

std::string name_of(const Sweep::Outcome& bed) { return bed.folder.filename().string(); }

Json beds_json(const OverBeds& o) {
  return {{"n", o.n}, {"mean", json_number(o.mean)}, {"half_width_95", json_number(o.half_width)}};
}

/// Figures of one wheel; those that no bed has are left out.
Json figures(std::span<const Json> wheels) {
  Json json = Json::object();
  for (const Figure& figure : kFigures) {
    std::vector<double> values;
    bool known = false;
    for (const Json& wheel : wheels) {
      known = known || wheel.contains(figure.name);
      const Json value = value_at(wheel, figure.place);
      if (value.is_number()) values.push_back(value.get<double>());
    }
    if (!known) continue;
    const OverBeds over = over_beds(values);
    json[figure.name] = {{"mean", json_number(over.mean)},
                         {"sd", json_number(over.sd)},
                         {"half_width_95", json_number(over.half_width)},
                         {"beds", beds_json(over)}};
  }
  return json;
}

Json entry(const Sweep::Outcome& bed, std::uint64_t seed, const Json& summary) {
  Json json{{"folder", name_of(bed)}, {"seed", seed}, {"done", bed.done}};
  if (!bed.done) {
    json["exit_code"] = static_cast<int>(bed.code);
    json["problem"] = bed.problem;
  }
  for (const char* key : {"mean", "sem", "n_eff", "steady", "unsteady_because"})
    json["drawbar_pull_N"][key] = value_at(summary, std::string("drawbar_pull_N.") + key);
  json["state_hash"] = value_at(summary, "state_hash");
  return json;
}

/// Checks whether a wheel of the run has a pull that is not steady.
bool unsteady(const Json& summary) {
  const Json wheels = value_at(summary, "wheels");
  for (const Json& wheel : wheels.is_array() ? wheels : Json::array())
    if (value_at(wheel, "drawbar_pull_N.steady") == false) return true;
  return false;
}

/// Digest of the scenario on the first bed; null if the folder belongs to a study. @param told sweep.json
Json digest_of_beds(const Json& told) { return value_at(told, "beds.scenario_digest"); }

}  // namespace

void require_beds(const scenario::Scenario& scenario, int beds) {
  const std::string file = scenario.file.string();
  const terrain::dem::DemOptions grains = scenario.grains("--seeds makes beds of grains that differ");
  if (!grains.bed.empty())
    throw input_error(file, "terrain.bed",
                      "is '" + grains.bed + "', expected none with --seeds: every bed would be this one");
  if (scenario.run.seed > kLargestSeed - static_cast<std::uint64_t>(beds))
    throw input_error(file, "run.seed", "is {}, expected at most {} with --seeds {}", scenario.run.seed,
                      kLargestSeed - static_cast<std::uint64_t>(beds), beds);
}

void require_no_beds(const fs::path& folder) {
  if (!digest_of_beds(read_json_if_whole(folder / "sweep.json")).is_null())
    throw input_error(folder.string(), "--out",
                      "holds the beds of 'furrow run --seeds', expected a new folder or that of a study");
}

void begin_beds(launch::RunDirectory& directory, const std::string& digest, bool overwrite) {
  const fs::path& folder = directory.path();
  const Json before = read_json_if_whole(folder / "sweep.json");
  if (before.is_object()) {
    const Json known = digest_of_beds(before);
    if (known.is_null())
      throw input_error(folder.string(), "--out", "holds a study, expected a new folder or that of beds");
    if (!overwrite && known != digest)
      throw input_error(folder.string(), "--out",
                        "holds beds of another scenario or other settings, expected a new folder or --overwrite");
    if (overwrite) directory.replace();
  }
  directory.add({"sweep.json", "summary.json", "summary_failed.json"});
  std::error_code error;  // the old ones cover fewer beds
  for (const char* name : {"summary.json", "summary_failed.json"}) fs::remove(folder / name, error);
}

OverBeds over_beds(std::span<const double> values) {
  OverBeds over{static_cast<int>(values.size()), NAN, NAN, NAN};
  if (values.empty()) return over;
  double sum = 0.0, squares = 0.0;
  for (const double value : values) sum += value;
  over.mean = sum / over.n;
  if (over.n < 2) return over;
  for (const double value : values) squares += (value - over.mean) * (value - over.mean);
  over.sd = std::sqrt(squares / (over.n - 1));
  over.half_width = student_t(over.n - 1) * over.sd / std::sqrt(over.n);
  return over;
}

Json summary_of_beds(const scenario::Scenario& scenario, std::span<const Sweep::Outcome> beds) {
  FURROW_ASSERT(!beds.empty(), beds.size());
  std::vector<std::vector<Json>> wheels(scenario.tires.size());
  std::vector<std::string> failed, not_steady, large_step;
  Json entries = Json::array();
  const Sweep::Outcome* first_failed = nullptr;
  for (std::size_t k = 0; k < beds.size(); ++k) {
    const Json summary = beds[k].done ? checkpoint::read_summary(beds[k].folder) : Json();
    entries.push_back(entry(beds[k], scenario.run.seed + k, summary));
    if (!beds[k].done) {
      if (!first_failed) first_failed = &beds[k];
      failed.push_back(name_of(beds[k]));
      continue;
    }
    if (unsteady(summary)) not_steady.push_back(name_of(beds[k]));
    if (value_at(summary, "interface.ok") == false) large_step.push_back(name_of(beds[k]));
    for (std::size_t w = 0; w < wheels.size(); ++w) wheels[w].push_back(value_at(summary, fmt::format("wheels.{}", w)));
  }
  Json json{{"format_version", 1},
            {"version", FURROW_VERSION},
            {"scenario", scenario.name},
            {"scenario_digest", scenario.digest},
            {"seeds", beds.size()}};
  if (first_failed)
    json["failed"] = {{"exit_code", static_cast<int>(first_failed->code)},
                      {"error", name_of(*first_failed) + ": " + first_failed->problem},
                      {"time_s", nullptr},
                      {"beds", failed}};
  Json of_wheels = Json::array();
  for (const std::vector<Json>& wheel : wheels) of_wheels.push_back(figures(wheel));
  json["beds"] = value_at(of_wheels, "0.drawbar_pull_N.beds");
  json["not_steady"] = not_steady;
  json["step_too_large"] = large_step;
  if (of_wheels.size() == 1) json.update(of_wheels.front());
  json["wheels"] = of_wheels;
  json["runs"] = entries;
  return json;
}

void write_summary_of_beds(const fs::path& folder, const Json& summary) {
  write_whole_file(folder / (summary.contains("failed") ? "summary_failed.json" : "summary.json"),
                   summary.dump(2) + "\n");
}

}  // namespace furrow::study
