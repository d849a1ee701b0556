// The runs of a study, one after another or several at once, each `furrow run` or `furrow resume` in a process of its
// own. What is finished stays: a sweep that was interrupted continues where it was.
//
//   <folder>/sweep.csv     one line per run: its keys, how it went, its results; of one that failed the means of what
//                          there is
//   <folder>/sweep.json    the study, for the plots
//   <folder>/runs/<digest> the folder of each run, named after its scenario's digest; <digest>.log: what it said. Runs
//                          that the study names are in <folder>/<name> instead
//   <folder>/beds/         of passes: the bed that each begins on
#pragma once

#include <sched.h>
#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

#include "nodes/launch/folder_lock.hpp"
#include "nodes/launch/progress.hpp"
#include "nodes/study/study.hpp"
#include "protocol/core/error.hpp"

namespace furrow::study {

struct SweepOptions {
  std::filesystem::path folder;
  int jobs = 1;  // runs at once; each has its own share of the cores
};

class Sweep {
 public:
  /// @throws Error(bad_input) when a run's scenario is wrong; nothing was written then
  Sweep(Study study, const SweepOptions& options);

  /// Before anything is written or removed. @throws Error(bad_input) where a file of the user's stands in a run's place
  void require_places() const;

  /// How many runs the folder's table has that are all none of this study's; 0 where one is.
  std::size_t runs_of_another_study() const;

  /// @param lock of the study's folder
  /// @returns done, stopped, or how the first run that failed ended
  /// @throws Error(io) when the folder was moved or removed meanwhile; its runs have ended then
  ExitCode run(const launch::FolderLock& lock);

  /// How a run ended, in the order of the study.
  struct Outcome {
    std::filesystem::path folder;
    bool done = false;
    ExitCode code = ExitCode::done;
    std::string problem;
  };
  std::vector<Outcome> outcomes() const;

 private:
  enum class State { waiting, running, done, failed, stopped };
  struct Run {
    nlohmann::ordered_json keys = nlohmann::ordered_json::object();       // what the user varies
    nlohmann::ordered_json passes_on = nlohmann::ordered_json::object();  // what a pass takes from those before
    int pass = 0;                                                         // 1, 2, …; 0: on a bed of its own
    State state = State::waiting;
    bool loaded = false;
    std::string digest, problem;
    std::string name;   // of its folder in the study's
    std::string cells;  // of its results in the table; empty ones until it has ended
    int exit_code = 0;
    pid_t process = -1;
    std::size_t share = 0;  // of the cores
    double done = 0.0;      // share of the run that is done, 0…1, by its log
  };

  void load(Run& run);
  void require_unlike_runs() const;
  std::filesystem::path folder_of(const Run& run) const;
  std::filesystem::path log_of(const Run& run) const;
  bool finished(const Run& run, const nlohmann::ordered_json& summary) const;
  std::vector<std::string> command(const Run& run) const;
  Run* next();
  bool prepare_bed(Run& run);
  void start(Run& run, std::size_t share);
  void poll(Run& run);
  void stop_all();
  void require_folder(const launch::FolderLock& lock);
  void pause_all();
  void fail(Run& run, const Error& error);
  void tell(const Run& run, const std::string& what);
  void tell_failure(const Run& run, const std::string& what);
  std::string line_of(const Run& run, const std::string& what) const;
  void show_progress();
  void keep_results(Run& run, const nlohmann::ordered_json& summary) const;
  void write_table() const;
  ExitCode outcome() const;

  Study study_;
  SweepOptions options_;
  std::vector<Run> runs_;
  std::vector<cpu_set_t> shares_;
  int told_stops_ = 0;
  launch::ProgressDisplay display_;
  double begin_ = 0.0;        // wall time at which the first run was started here, s
  double begin_share_ = 0.0;  // of the study, done then
  double looked_ = 0.0;       // wall time of the last look at the logs, s
};

}  // namespace furrow::study
