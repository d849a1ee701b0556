// The runs of a study, one after another or several at once, each a process of `furrow run` or `furrow resume`.
// Finished runs stay: an interrupted sweep continues.
//
//   <folder>/sweep.csv     one line per run: its keys, its outcome, its results; for a failed run the means of the
//                          available lines
//   <folder>/sweep.json    the study, for the plots
//   <folder>/runs/<digest> the folder of each run, named after its scenario's digest; <digest>.log: its output. Runs
//                          with names in the study are in <folder>/<name> instead
//   <folder>/beds/         for passes: the bed at the beginning of each
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
  /// @throws Error(bad_input) if a run's scenario is wrong; nothing was written then
  Sweep(Study study, const SweepOptions& options);

  /// Call it before anything is written or removed. @throws Error(bad_input) if a user's file is in a run's place
  void require_places() const;

  /// Number of runs in the folder's table if none of them belongs to this study; otherwise 0.
  std::size_t runs_of_another_study() const;

  /// @param lock of the study's folder
  /// @returns done, stopped, or the exit code of the first run that failed
  /// @throws Error(io) if the folder was moved or removed meanwhile; its runs have ended then
  ExitCode run(const launch::FolderLock& lock);

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
    nlohmann::ordered_json keys = nlohmann::ordered_json::object();       // varied by the user
    nlohmann::ordered_json passes_on = nlohmann::ordered_json::object();  // inputs of a pass from earlier ones
    int pass = 0;                                                         // 1, 2, …; 0: on a bed of its own
    State state = State::waiting;
    bool loaded = false;
    std::string digest, problem;
    std::string name;   // of its folder in the study's
    std::string cells;  // its results in the table; empty cells until it has ended
    int exit_code = 0;
    pid_t process = -1;
    std::size_t share = 0;  // of the cores
    double done = 0.0;      // share of the run done, 0…1, from its log
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
  double begin_ = 0.0;        // wall time when this process started its first run, s
  double begin_share_ = 0.0;  // of the study, at that time
  double looked_ = 0.0;       // wall time when the logs were last read, s
};

}  // namespace furrow::study
