#include "nodes/checkpoint/resume.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "nodes/checkpoint/run_summary.hpp"
#include "nodes/launch/run_directory.hpp"
#include "nodes/scenario/load_scenario.hpp"
#include "nodes/scenario/model_keys.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/json_text.hpp"
#include "protocol/files/program_id.hpp"
#include "protocol/files/text_file.hpp"

namespace furrow::checkpoint {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using scenario::Settings;

/// Converts "/rig/slip" to "rig.slip".
std::string dotted(const std::string& pointer) {
  std::string key = pointer.substr(pointer.empty() ? 0 : 1);
  for (char& c : key)
    if (c == '/') c = '.';
  return key;
}

std::string reason_for(const std::string& key) {
  if (scenario::steps_finer(key)) return "; only one that failed may be stepped more finely";
  return key == "output.series_interval" ? ", and means count all lines of a series equally" : "";
}

/// Keys whose values differ, with the new ones. @throws Error(bad_input) at the first that may not differ
/// @param failed whether the run has failed, and may therefore be stepped more finely
json changes(const fs::path& run, const json& before, const json& now, bool failed) {
  json changed = json::object(), keys = before.flatten();
  keys.update(now.flatten());
  const json old_values = before.flatten(), new_values = now.flatten();
  std::vector<std::string> pointers;
  for (const auto& [pointer, unused] : keys.items()) pointers.push_back(pointer);
  // Another model brings other keys with it: the key that chose it is reported first.
  std::stable_partition(pointers.begin(), pointers.end(),
                        [](const std::string& pointer) { return scenario::chooses_model(dotted(pointer)); });
  for (const std::string& pointer : pointers) {
    const json was = old_values.value(pointer, json()), is = new_values.value(pointer, json());
    if (was == is) continue;
    const std::string key = dotted(pointer);
    const bool finer = failed && scenario::steps_finer(key);
    if (!finer && !scenario::may_change_on_resume(key))
      throw input_error(
          run.string(), key,
          "is {} but the run was computed with {}, expected the same: a run that is continued may change run.end, "
          "run.average_from, run.threads, run.peer_timeout, output.frame_interval and checkpoint.*, not its physics{}",
          value_text(is), value_text(was), reason_for(key));
    changed[key] = is;
  }
  return changed;
}

void check_files(const scenario::Scenario& scenario, const CheckpointManifest& manifest) {
  const std::vector<std::string> hashes = scenario.file_hashes();
  const std::vector<scenario::InputFile> files = scenario.input_files();
  FURROW_ASSERT(hashes.size() == files.size(), hashes.size(), files.size());
  for (std::size_t k = 0; k < files.size() && k < manifest.file_hashes.size(); ++k)
    if (hashes[k] != manifest.file_hashes[k])
      throw input_error(scenario.file.string(), files[k].key,
                        "'" + files[k].path.string() +
                            "' was changed since the run began, expected the file that it was computed with");
}

ResumePoint newest_whole(const fs::path& run, std::vector<std::string>& problems) {
  for (const fs::path& folder : list_checkpoints(run)) {
    try {
      return {folder, read_checkpoint(folder), "", ""};
    } catch (const Error& error) {
      problems.push_back(error.what());
    }
  }
  if (problems.empty())
    throw input_error(run.string(), "",
                      "holds no checkpoint, expected one in " + checkpoints_folder(run).string() +
                          "; start again with furrow run --overwrite");
  std::string text;
  for (const std::string& problem : problems) text += problem + "\n";
  throw Error(ExitCode::io, text + run.string() + ": no checkpoint is whole, nothing can be continued");
}

/// Converts the checkpoint's steps to those of the continuing run, which are an equal part of them.
/// @throws Error(bad_input) if they are not
void count_in_steps_of(double step, double before, const fs::path& run, CheckpointManifest& manifest) {
  const auto ratio = static_cast<std::int64_t>(std::llround(before / step));
  if (ratio < 1 || std::abs(before - static_cast<double>(ratio) * step) > 1e-9 * before)
    throw input_error(run.string(), "run.step",
                      "is {} s but the run was computed with {} s, expected a half, a third, … of it",
                      number_text(step), number_text(before));
  const auto count = [&](std::int64_t& steps) {
    if (steps > kMostSteps / ratio)
      throw input_error(run.string(), "run.step", "is {} s, too many steps to be counted, expected more",
                        number_text(step));
    steps *= ratio;
  };
  count(manifest.step), count(manifest.frames.every), count(manifest.frames.first_step);
  for (Segment& segment : manifest.segments) count(segment.from_step), count(segment.to_step);
}

/// Checks that substeps keys only grow. @throws Error(bad_input)
void check_finer(const fs::path& run, const json& before, const json& changed) {
  for (const auto& [key, value] : changed.items()) {
    if (!key.ends_with(".substeps")) continue;
    const json::json_pointer pointer("/" + key.substr(0, key.find('.')) + "/substeps");
    const auto was = before.value(pointer, 1);
    if (value.is_number_integer() && value.get<int>() < was)
      throw input_error(run.string(), key, "is {} but the run was computed with {}, expected more", value.get<int>(),
                        was);
  }
}

bool only_finer(const json& changed) {
  bool any = false;
  for (const auto& [key, value] : changed.items()) {
    if (key == "run.end" || key == "run.average_from") return false;
    any = any || scenario::steps_finer(key);
  }
  return any;
}

/// Warning for a failed run that continues without changes. @param failed summary_failed.json
std::string failure_ahead(const fs::path& run, const nlohmann::ordered_json& failed) {
  const auto text = value_at(failed, "failed.error"), time = value_at(failed, "failed.time_s");
  return fmt::format("{}: failed at t = {} s and will fail again, as nothing is changed: {}", run.string(),
                     time.is_number() ? number_text(time.get<double>()) : "?",
                     text.is_string() ? text.get<std::string>() : "");
}

/// Files count by their content, at any place: check_files() compares that.
json with_places_of(json document, const json& other, const scenario::Scenario& scenario) {
  for (const scenario::InputFile& file : scenario.input_files()) {
    std::string pointer = "/" + file.key;
    std::replace(pointer.begin(), pointer.end(), '.', '/');
    const json::json_pointer at(pointer);
    if (document.contains(at) && other.contains(at)) document[at] = other[at];
  }
  return document;
}

/// The bed between two passes is in the study's folder; if that was moved, the bed's old name is wrong.
Settings bed_of_moved_study(const fs::path& run, const fs::path& file) {
  const json document = read_json_if_whole(file);
  const json named = document.is_object() ? document.value(json::json_pointer("/terrain/bed"), json()) : json();
  std::error_code error;
  if (!named.is_string() || fs::exists(named.get<std::string>(), error)) return {};
  const fs::path whole = fs::canonical(run, error);
  const fs::path bed = whole.parent_path().parent_path() / "beds" / fs::path(named.get<std::string>()).filename();
  if (error || !fs::is_regular_file(bed, error)) return {};
  return {{"terrain.bed", bed.string()}};
}

/// Compares the scenario of the plan's checkpoint with the one that continues, and puts changes into the plan.
/// @param failed summary_failed.json @throws Error(bad_input), Error(io) for a scenario that is damaged
void take_changes(const fs::path& run, const nlohmann::ordered_json& failed, ResumePlan& plan) try {
  ResumePoint& point = plan.point;
  const json now = json::parse(plan.scenario.completed);
  const json before = with_places_of(json::parse(point.manifest.scenario), now, plan.scenario);
  const bool physics = value_at(failed, "failed.exit_code") == static_cast<int>(ExitCode::physics);
  const json changed = changes(run, before, now, physics);
  if (!changed.empty()) point.changed = changed.dump();
  check_finer(run, before, changed);
  if (only_finer(changed)) point.finer_than = point.manifest.scenario_digest;
  if (physics && value_at(failed, "scenario_digest") == plan.scenario.digest)
    plan.warnings.push_back(failure_ahead(run, failed));
  if (changed.contains("run.step"))
    count_in_steps_of(plan.scenario.run.step, before.at("run").at("step").get<double>(), run, point.manifest);
} catch (const json::exception& problem) {
  throw io_error(plan.point.folder.string(),
                 std::string("the scenario of the checkpoint is damaged: ") + problem.what());
}

}  // namespace

std::string restore_scenario(const fs::path& run) {
  const fs::path file = run / "scenario.json";
  std::error_code error;
  if (fs::exists(file, error) || list_checkpoints(run).empty()) return {};
  const ResumePoint point = last_checkpoint(run);
  write_whole_file(file, point.manifest.scenario + "\n");
  return fmt::format("{}: was missing and is restored from {}", file.string(), point.folder.string());
}

ResumePoint last_checkpoint(const fs::path& run) {
  std::vector<std::string> problems;
  return newest_whole(run, problems);
}

ResumePlan plan_resume(const fs::path& run, const Settings& changed) {
  launch::require_run_directory(run);
  std::error_code error;
  const fs::path file = run / "scenario.json";
  if (fs::exists(run / "sweep.json", error))
    throw input_error(
        run.string(), "",
        "holds several runs, expected the folder of one of them; the command that began them continues them all");
  if (!fs::exists(file, error) && list_checkpoints(run).empty())
    throw input_error(
        run.string(), "",
        "holds a run that never began to step, expected scenario.json in it; start again with furrow run --overwrite");
  if (!fs::exists(file, error))
    throw input_error(file.string(), "", "is missing, expected it; furrow resume without mpirun restores it");
  ResumePlan plan;
  const Settings moved = bed_of_moved_study(run, file);
  Settings settings = moved;
  settings.insert(settings.end(), changed.begin(), changed.end());
  plan.scenario = scenario::load_scenario(file, settings);
  const std::int64_t steps = plan.scenario.run.steps(), ended = finished_at(run);
  const bool done = ended == steps || ended_early(run);
  const std::vector<std::string> lost =
      done ? lost_results(run, plan.scenario.output.frame_interval > 0.0) : std::vector<std::string>();
  // It can be made again from the final checkpoint and the series.
  const bool again = lost.size() == 1 && lost.front() == "results.h5" && !list_checkpoints(run).empty();
  for (const std::string& file : lost)
    plan.warnings.push_back((run / file).string() + (again
                                                         ? ": is missing and is written again from the last checkpoint"
                                                         : ": is missing and cannot be made again: bring it back, or "
                                                           "compute the run anew with furrow run --overwrite"));
  if (done && !again) {
    const json now = json::parse(plan.scenario.completed);
    const json before = json::parse(scenario::load_scenario(file, moved).completed);
    const json asked = changes(run, with_places_of(before, now, plan.scenario), now, false);
    for (const auto& [key, value] : asked.items())
      plan.warnings.push_back(
          fmt::format("{}: key '{}': is not changed to {}, as the run is finished; with a later --until it is, and the "
                      "run continues",
                      run.string(), key, value.dump()));
    plan.finished = true;
    plan.ended = static_cast<double>(ended) * plan.scenario.run.step;
    return plan;
  }
  plan.point = newest_whole(run, plan.warnings);
  const CheckpointManifest& manifest = plan.point.manifest;
  plan.scenario.name = manifest.name;
  take_changes(run, read_failed_summary(run), plan);
  check_files(plan.scenario, manifest);
  if (const terrain::TerrainDescription terrain = plan.scenario.terrain->describe(); !terrain.exact_restart)
    plan.warnings.push_back(fmt::format("{}: the engine '{}' continues with the same physics, not with the same bits",
                                        run.string(), terrain.engine));
  const std::int64_t reached = std::max(ended, manifest.step);
  if (steps < reached)
    throw input_error(run.string(), "run.end", "is {} s, but the run has reached {} s, expected that or later",
                      number_text(plan.scenario.run.end),
                      number_text(static_cast<double>(reached) * plan.scenario.run.step));
  if (manifest.build != build_id())
    plan.warnings.push_back(run.string() + ": the checkpoint is of another build of furrow (" + manifest.version +
                            "): the run continues, but not bit for bit");
  else if (manifest.arithmetic != arithmetic_id())
    plan.warnings.push_back(run.string() +
                            ": the checkpoint is of a machine or setting where the C library's mathematical functions "
                            "give other last digits: the run continues, but not bit for bit");
  else if (manifest.cpu != cpu_model())
    plan.warnings.push_back(run.string() + ": the checkpoint is of another processor (" + manifest.cpu +
                            "): the run continues, perhaps not bit for bit");
  return plan;
}

}  // namespace furrow::checkpoint
