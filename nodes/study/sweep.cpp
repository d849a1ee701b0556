#include "nodes/study/sweep.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>
#include <csignal>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <map>
#include <new>
#include <sstream>
#include <utility>

#include <fmt/format.h>

#include "nodes/checkpoint/checkpoint.hpp"
#include "nodes/checkpoint/run_summary.hpp"
#include "nodes/launch/child_process.hpp"
#include "nodes/launch/run_directory.hpp"
#include "nodes/launch/run_list.hpp"
#include "nodes/launch/run_log.hpp"
#include "nodes/launch/signals.hpp"
#include "nodes/scenario/load_scenario.hpp"
#include "nodes/scenario/memory_check.hpp"
#include "nodes/study/pass_bed.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/core/clock.hpp"
#include "protocol/files/digits.hpp"
#include "protocol/files/nearest_words.hpp"
#include "protocol/files/text_file.hpp"
#include "protocol/host.hpp"
#include "terrain/dem/beds/bed_cache.hpp"

namespace furrow::study {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using checkpoint::read_summary, checkpoint::read_failed_summary, checkpoint::number_at, checkpoint::value_at;

constexpr int kPoll = 20000;      // µs
constexpr double kDeepRut = 0.4;  // of the bed's depth: at this depth the floor affects the tire
constexpr double kLook = 2.0;     // s between checks of the runs' progress

std::string cell(const Json& value) {
  if (value.is_null()) return "";
  const std::string text = value.is_string() ? value.get<std::string>() : value.dump();
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

/// Divides this process's cores into equal shares; each share has all cores if there are too few.
std::vector<cpu_set_t> core_shares(int jobs) {
  FURROW_ASSERT(jobs > 0, jobs);
  const std::vector<int> cores = allowed_cores();
  const int shares = std::min(jobs, static_cast<int>(cores.size()));
  std::vector<cpu_set_t> sets(jobs);
  for (int job = 0; job < jobs; ++job) {
    CPU_ZERO(&sets[job]);
    for (int i = 0; i < static_cast<int>(cores.size()); ++i)
      if (shares < jobs || i * shares / static_cast<int>(cores.size()) == job) CPU_SET(cores[i], &sets[job]);
  }
  return sets;
}

bool readable(const fs::path& bed) try {
  terrain::dem::read_bed(bed);
  return true;
} catch (const Error&) {
  return false;  // missing or damaged: the run is repeated
}

/// Names of all values as `results` takes them, "iso_w.force_N.0".
void add_names(const Json& value, const std::string& name, std::vector<std::string>& names) {
  if (!value.is_structured()) return names.push_back(name);
  for (const auto& [key, one] : value.items()) add_names(one, name.empty() ? key : name + "." + key, names);
}

std::string without_result(const Json& summary, const std::string& name) {
  std::vector<std::string> names;
  add_names(summary, "", names);
  const std::string text = "has no result '" + name + "'";
  if (value_at(summary, "wheels").size() > 1 && !value_at(summary, "wheels.0." + name).is_null())
    return text + " for all its wheels, expected that of one: 'wheels.0." + name + "'";
  if (std::ranges::find(names, name) != names.end()) return text + ": it was not measured";
  std::string similar;
  for (const std::string& one : nearest_words(name, names))
    similar += (similar.empty() ? "" : " or ") + fmt::format("'{}'", one);
  return text + (similar.empty() ? ", expected a value of its summary.json" : ", expected " + similar + "?");
}

std::string state_name(int state) {
  FURROW_ASSERT(in_range(state, 5), state);
  constexpr const char* kNames[] = {"waiting", "running", "done", "failed", "stopped"};
  return kNames[state];
}

}  // namespace

Sweep::Sweep(Study study, const SweepOptions& options)
    : study_(std::move(study)), options_(options), shares_(core_shares(options.jobs)) {
  FURROW_ASSERT(study_.names.empty() || (study_.names.size() == study_.runs.size() && study_.passes == 0),
                study_.names.size(), study_.runs.size(), study_.passes);
  for (std::size_t k = 0; k < study_.runs.size(); ++k)
    for (int pass = study_.passes > 0 ? 1 : 0; pass <= study_.passes; ++pass) {
      runs_.emplace_back();
      runs_.back().keys = study_.runs[k];
      runs_.back().pass = pass;
      runs_.back().cells.assign(study_.results.size(), ',');
      if (!study_.names.empty()) runs_.back().name = study_.names[k];
      if (pass <= 1) load(runs_.back());
    }
  require_unlike_runs();
}

/// Runs with the same digest would share a folder.
void Sweep::require_unlike_runs() const {
  if (!study_.names.empty()) return;
  std::map<std::string, const Run*> known;
  for (const Run& run : runs_) {
    if (!run.loaded) continue;
    const auto [of_digest, is_new] = known.try_emplace(run.digest, &run);
    if (is_new) continue;
    const auto words = [](const Run& r) { return r.keys.empty() ? std::string("no settings") : text_of(r.keys); };
    throw input_error(study_.file.string(), "",
                      "has a run with {} and a run with {}, which have the same results: what they differ in is the "
                      "scenario's value or decides no result, expected each once",
                      words(*of_digest->second), words(run));
  }
}

void Sweep::require_places() const {
  for (const Run& run : runs_)
    if (run.loaded) launch::require_own(options_.folder, {run.name + ".log"});
}

std::size_t Sweep::runs_of_another_study() const {
  const fs::path table = options_.folder / "sweep.csv";
  std::error_code error;
  if (!fs::is_regular_file(table, error)) return 0;
  std::istringstream lines(read_whole_file(table));
  std::size_t others = 0;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t begin = line.find(',') + 1, end = line.find(',', begin);
    const std::string folder = line.substr(begin, end - begin);
    if (!folder.starts_with("runs/")) continue;
    ++others;
    for (const Run& run : runs_)
      if (run.name == folder) return 0;
  }
  return others;
}

void Sweep::load(Run& run) {
  Json all = study_.common;
  all.update(run.keys);
  all.update(run.passes_on);
  try {
    const scenario::Scenario scenario = scenario::load_scenario(study_.scenario, settings_of(all));
    if (study_.passes > 1) (void)scenario.grains("passes hand over a bed of grains");
    if (study_.passes > 1 && !scenario.checkpoint.at_end)
      throw input_error(study_.scenario.string(), "checkpoint.at_end",
                        "is false, expected true: the next pass begins on the checkpoint at the end");
    run.digest = scenario.digest;
    if (study_.names.empty()) run.name = "runs/" + run.digest;
  } catch (const Error& error) {
    throw Error(error.code(), fmt::format("{}\n{}: in the run with {}", error.what(), study_.file.string(),
                                          run.keys.empty() ? "these settings" : text_of(run.keys)));
  }
  run.loaded = true;
}

fs::path Sweep::folder_of(const Run& run) const { return options_.folder / run.name; }
fs::path Sweep::log_of(const Run& run) const { return options_.folder / (run.name + ".log"); }

bool Sweep::finished(const Run& run, const Json& summary) const {
  if (!summary.is_object()) return false;
  if (value_at(summary, "scenario_digest") == run.digest) return true;
  // The run was continued after a failure with a smaller step.
  const Json segments = value_at(summary, "segments");
  return std::any_of(segments.begin(), segments.end(),
                     [&](const Json& segment) { return value_at(segment, "finer_than") == run.digest; });
}

std::vector<std::string> Sweep::command(const Run& run) const {
  std::error_code error;
  const std::string program = this_program().string();
  const fs::path folder = folder_of(run);
  if (!checkpoint::list_checkpoints(folder).empty()) return {program, "resume", "--no-plots", "--", folder.string()};
  std::vector<std::string> list{program, "run", "--no-plots", "--out=" + folder.string()};
  if (fs::exists(folder, error)) list.emplace_back("--overwrite");
  Json all = study_.common;
  all.update(run.keys);
  all.update(run.passes_on);
  for (const auto& [key, value] : settings_of(all)) list.push_back("--set=" + key + "=" + value);
  list.emplace_back("--");  // names may begin with a hyphen
  list.push_back(study_.scenario.string());
  return list;
}

void Sweep::tell(const Run& run, const std::string& what) { display_.say(line_of(run, what)); }
void Sweep::tell_failure(const Run& run, const std::string& what) { display_.say_error(line_of(run, what)); }

std::string Sweep::line_of(const Run& run, const std::string& what) const {
  const auto number = static_cast<std::size_t>(&run - runs_.data()) + 1;
  std::string keys = text_of(run.keys);
  if (run.pass > 0) keys += fmt::format("{}pass {}", keys.empty() ? "" : ", ", run.pass);
  return fmt::format("furrow: run {} of {} ({}) {}", number, runs_.size(), keys, what);
}

/// Shows how much of the study is done and the time left; all runs count the same.
void Sweep::show_progress() {
  const double now = wall_clock();
  if (now - looked_ < kLook) return;
  looked_ = now;
  double share = 0.0;
  std::size_t done = 0;
  for (Run& run : runs_) {
    if (run.state == State::done || run.state == State::failed) run.done = 1.0, ++done;
    if (run.state == State::running) run.done = std::max(run.done, launch::share_in_log(log_of(run)));
    share += run.done / static_cast<double>(runs_.size());
  }
  if (begin_ == 0.0) begin_ = now, begin_share_ = share;
  const bool under_way = share > 0.0 && share < 1.0;  // then the share is printed
  launch::Progress progress{.phase = fmt::format("{} of {} runs done{}", done, runs_.size(), under_way ? "," : ""),
                            .share = share};
  if (share > begin_share_) progress.eta = (now - begin_) * (1.0 - share) / (share - begin_share_);
  display_.show(progress);
}

/// The next run to start; null if none can start now.
Sweep::Run* Sweep::next() {
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    Run& run = runs_[i];
    if (run.state == State::done) continue;
    if (run.state != State::waiting) continue;
    if (run.pass > 1 && runs_[i - 1].state != State::done) continue;
    if (!run.loaded && !prepare_bed(run)) {
      if (launch::stop_signalled()) return nullptr;
      continue;
    }
    const Json summary = read_summary(folder_of(run));
    if (!finished(run, summary)) return &run;
    run.state = State::done;
    keep_results(run, summary);
    const std::vector<std::string> lost = checkpoint::lost_results(folder_of(run), false);
    tell(run, lost.empty() ? "is done already"
                           : fmt::format("is done already, but {} is missing: see furrow resume {}", lost.front(),
                                         folder_of(run).string()));
  }
  return nullptr;
}

/// Makes the bed of a pass from that of the previous pass, after a rest; sinkage counts from the surface before the
/// first.
/// @returns false if there is none: stopped by a signal, or the run has failed
bool Sweep::prepare_bed(Run& run) try {
  FURROW_ASSERT(run.pass > 1, run.pass);
  const Run& before = *(&run - 1);
  const Run& first = *(&run - (run.pass - 1));
  const fs::path bed = options_.folder / "beds" / fmt::format("{}_rest_{}.h5", before.digest, study_.rest);
  std::error_code error;
  if (!readable(bed)) {
    launch::add_to_run_list(options_.folder, {"beds/", "beds/" + bed.filename().string()});
    fs::create_directory(bed.parent_path(), error);
    const terrain::dem::SettleResult rest =
        make_pass_bed(folder_of(before), study_.rest, launch::shown_on(display_, " while the bed rested"), bed);
    tell(run, fmt::format("begins on the bed after {:.2g} s: {}, net force {:.1e} of the contact forces, {:.2g} mm/s",
                          rest.time, rest.settled ? "settled" : "NOT settled", rest.force_ratio, 1e3 * rest.speed));
  }
  run.passes_on["terrain.bed"] = fs::absolute(bed, error).string();
  run.passes_on["terrain.undisturbed_height"] = value_at(read_summary(folder_of(first)), "wheels.0.surface_height_m");
  load(run);
  return true;
} catch (const std::bad_alloc&) {
  fail(run, scenario::out_of_memory());
  return false;
} catch (const Error& error) {
  if (error.code() == ExitCode::stopped) return false;
  fail(run, error);
  return false;
}

void Sweep::fail(Run& run, const Error& error) {
  run.state = State::failed;
  run.exit_code = static_cast<int>(error.code());
  run.problem = error.what();
  tell_failure(run, fmt::format("FAILED with exit code {}: {}", run.exit_code, run.problem));
  write_table();
}

void Sweep::start(Run& run, std::size_t share) {
  FURROW_ASSERT(in_range(share, shares_.size()), share, shares_.size());
  FURROW_ASSERT(run.state == State::waiting && run.loaded, static_cast<int>(run.state), run.loaded);
  std::error_code error;
  launch::add_to_run_list(options_.folder, {study_.names.empty() ? "runs/" : run.name + "/", run.name + ".log"});
  fs::create_directory(folder_of(run).parent_path(), error);
  launch::wait_until_free(folder_of(run));  // ranks outlive a killed supervisor by a second or two
  const std::vector<std::string> list = command(run);
  const int log = open(log_of(run).c_str(), O_WRONLY | O_CREAT | O_APPEND | O_NOFOLLOW | O_CLOEXEC, 0666);
  const auto prepare = [cores = shares_[share]] {
    sched_setaffinity(0, sizeof cores, &cores);
    launch::forget_launcher();
    launch::make_no_parents();
  };
  run.process = launch::start_child(
      {.command = list, .out = log, .err = log, .own_group = true, .death_signal = SIGTERM, .prepare = prepare});
  close(log);
  run.share = share;
  run.state = State::running;
  tell(run, list[1] == "resume" ? "continues" : "begins");
}

void Sweep::poll(Run& run) {
  FURROW_ASSERT(run.process > 0 && run.state == State::running, run.process, static_cast<int>(run.state));
  int status = 0;
  const pid_t ended = waitpid(run.process, &status, WNOHANG);
  if (ended == 0 || (ended < 0 && errno == EINTR)) return;
  if (ended < 0) status = SIGKILL;  // the child no longer exists, and nothing shows how it ended
  run.process = -1;
  run.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : static_cast<int>(ExitCode::rank_lost);
  const Json summary = read_summary(folder_of(run));
  if (run.exit_code == static_cast<int>(ExitCode::stopped)) {
    run.state = State::stopped;
    tell(run, "was stopped");
  } else if (run.exit_code == 0 && finished(run, summary)) {
    run.state = State::done;
    keep_results(run, summary);
    for (const std::string& name : study_.chosen_results)
      if (value_at(summary, name).is_null()) tell(run, without_result(summary, name));
    const double pull = number_at(summary, "drawbar_pull_N.mean");  // not every rig has one
    const bool unsteady = value_at(summary, "drawbar_pull_N.steady") == false;
    std::string told = "is done";
    if (std::isfinite(pull))
      told += fmt::format(": pull {} N{}", with_error(pull, number_at(summary, "drawbar_pull_N.sem")),
                          unsteady ? ", NOT STEADY" : "");
    if (value_at(summary, "interface.ok") == false) told += ", THE STEP IS TOO LARGE";
    tell(run, told);
    if (const double deep = number_at(summary, "wheels.0.sinkage_m") / number_at(summary, "wheels.0.surface_height_m");
        run.pass > 0 && deep > kDeepRut)
      tell(run, fmt::format("stands {:.0f} % of the bed's depth in it: the floor carries it too; a deeper bed is "
                            "needed for soil without a floor (more terrain.layers)",
                            100.0 * deep));
  } else {
    run.state = State::failed;
    keep_results(run, read_failed_summary(folder_of(run)));
    run.problem = run.exit_code == 0 ? "holds the results of another scenario: it was resumed with other keys, or "
                                       "files were changed meanwhile; remove it to run it again"
                                     : launch::last_error(log_of(run), status);
    if (run.exit_code == 0) run.exit_code = static_cast<int>(ExitCode::bad_input);
    tell_failure(run,
                 fmt::format("FAILED with exit code {}: {}; see {}", run.exit_code, run.problem, log_of(run).string()));
  }
  write_table();
}

void Sweep::stop_all() {
  if (launch::stop_signals() == told_stops_) return;
  told_stops_ = launch::stop_signals();
  for (const Run& run : runs_)
    if (run.process > 0) kill(run.process, SIGTERM);
}

/// Checks that the folder exists: it must not be made again if it was moved or removed. Its runs check this too.
void Sweep::require_folder(const launch::FolderLock& lock) {
  if (lock.stands()) return;
  for (Run& run : runs_) {
    if (run.process <= 0) continue;
    kill(run.process, SIGTERM);
    while (waitpid(run.process, nullptr, 0) < 0 && errno == EINTR) continue;
    run.process = -1;
  }
  throw io_error(
      options_.folder.string(),
      "was moved, removed or emptied while the study was under way; it ends here and writes nothing elsewhere");
}

/// Only this process receives Ctrl-Z: the runs have groups of their own.
void Sweep::pause_all() {
  if (!launch::pause_asked()) return;
  std::vector<int> stopped;
  for (const Run& run : runs_)
    if (run.process > 0) stopped.push_back(run.process);
  for (const int process : stopped) kill(process, SIGTSTP);
  launch::pause_here(stopped);
  for (const int process : stopped) kill(process, SIGCONT);
}

ExitCode Sweep::run(const launch::FolderLock& lock) {
  launch::add_to_run_list(options_.folder, {"sweep.json", "sweep.csv"});
  launch::catch_pause();
  Json told{{"format_version", 1},   {"study", study_.name},      {"passes", study_.passes},
            {"rest_s", study_.rest}, {"results", study_.results}, {"plot", study_.plot}};
  if (!study_.description.empty()) told["description"] = study_.description;
  if (!study_.names.empty()) told["beds"] = {{"scenario_digest", runs_.front().digest}};
  write_whole_file(options_.folder / "sweep.json", told.dump(2) + "\n");
  write_table();
  std::vector<bool> taken(shares_.size(), false);
  for (bool running = true; running;) {
    for (std::size_t share = 0; share < taken.size() && !launch::stop_signalled(); ++share) {
      if (taken[share]) continue;
      Run* run = next();
      if (!run) break;
      require_folder(lock);
      start(*run, share);
      taken[share] = true;
    }
    running = false;
    require_folder(lock);
    for (Run& run : runs_) {
      if (run.process <= 0) continue;
      poll(run);
      if (run.process <= 0) taken[run.share] = false;
      running = true;
    }
    if (running) {
      show_progress();
      usleep(kPoll);
    }
    stop_all();
    pause_all();
  }
  display_.clear();
  write_table();
  return outcome();
}

/// Keeps a run's results once it ends, because the table is rewritten after each run and would need all summaries.
void Sweep::keep_results(Run& run, const Json& summary) const {
  run.cells.clear();
  for (const std::string& name : study_.results) run.cells += "," + cell(value_at(summary, name));
}

void Sweep::write_table() const {
  std::vector<std::string> keys;
  for (const Run& run : runs_)
    for (const auto& [key, unused] : run.keys.items())
      if (std::find(keys.begin(), keys.end(), key) == keys.end()) keys.push_back(key);
  std::string text = study_.passes > 0 ? "run,folder,state,exit_code,pass" : "run,folder,state,exit_code";
  for (const std::vector<std::string>* names : {&std::as_const(keys), &study_.results})
    for (const std::string& name : *names) text += "," + cell(name);
  text += ",problem\n";
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    const Run& run = runs_[i];
    text += fmt::format("{},{},{},{}", i + 1, run.loaded ? run.name : "", state_name(static_cast<int>(run.state)),
                        run.state == State::done || run.state == State::failed ? std::to_string(run.exit_code) : "");
    if (run.pass > 0) text += fmt::format(",{}", run.pass);
    for (const std::string& key : keys) text += "," + (run.keys.contains(key) ? cell(run.keys[key]) : "");
    text += run.cells + "," + cell(run.problem) + "\n";
  }
  write_whole_file(options_.folder / "sweep.csv", text);
}

std::vector<Sweep::Outcome> Sweep::outcomes() const {
  std::vector<Outcome> all;
  for (const Run& run : runs_)
    all.push_back({folder_of(run), run.state == State::done, static_cast<ExitCode>(run.exit_code), run.problem});
  return all;
}

ExitCode Sweep::outcome() const {
  if (launch::stop_signalled()) return ExitCode::stopped;
  for (const Run& run : runs_)
    if (run.state == State::failed) return static_cast<ExitCode>(run.exit_code);
  return ExitCode::done;
}

}  // namespace furrow::study
