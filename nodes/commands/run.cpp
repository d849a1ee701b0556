// `furrow run` and `furrow resume` outside MPI: checks first, then starts and watches the ranks, then shows the result.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <memory>

#include <nlohmann/json.hpp>

#include "nodes/checkpoint/checkpoint.hpp"
#include "nodes/checkpoint/resume.hpp"
#include "nodes/checkpoint/run_summary.hpp"
#include "nodes/commands/command_table.hpp"
#include "nodes/launch/limits.hpp"
#include "nodes/launch/messages.hpp"
#include "nodes/launch/run_directory.hpp"
#include "nodes/launch/signals.hpp"
#include "nodes/launch/start_watch.hpp"
#include "nodes/launch/supervisor.hpp"
#include "nodes/scenario/load_scenario.hpp"
#include "nodes/scenario/memory_check.hpp"
#include "nodes/scenario/runnable.hpp"
#include "protocol/core/no_step_helps.hpp"
#include "protocol/files/json_text.hpp"
#include "protocol/files/text_file.hpp"
#include "protocol/mpi_transport.hpp"

namespace furrow::commands {
namespace {

constexpr const char* kDone = "summary.json";  // is in the folder if and only if the run is complete

std::vector<std::string> rank_arguments(const RunArguments& arguments, const std::filesystem::path& directory) {
  std::vector<std::string> list{arguments.resume ? "resume" : "run"};
  if (!arguments.resume) list.push_back("--out=" + directory.string());
  for (const auto& [key, value] : arguments.settings) list.push_back("--set=" + key + "=" + value);
  if (arguments.profile) list.push_back("--profile");
  list.push_back("--");  // names may begin with a hyphen
  list.push_back(arguments.resume ? directory.string() : arguments.scenario.string());
  return list;
}

void tell_result(const scenario::Scenario& scenario, const std::filesystem::path& directory, bool plots) {
  launch::say(result_text(directory, scenario));
  if (!plots) return;
  const auto made = make_report_or_warn(directory);
  if (made.empty()) return;
  const auto page = std::find_if(made.begin(), made.end(),
                                 [](const std::filesystem::path& file) { return file.extension() == ".html"; });
  if (page != made.end())
    launch::say("furrow: open {} in a browser to see the whole run; {} plots are beside it\n", page->string(),
                made.size() - 1);
  else
    launch::say("furrow: plots: {} and {} more\n", made.front().string(), made.size() - 1);
}

/// Prints how to continue a run that did not finish. A failure of physics repeats itself if nothing is changed.
void tell_how_to_continue(const std::filesystem::path& directory, const launch::LaunchResult& result,
                          const scenario::Scenario& scenario) {
  const std::string folder = scenario::shell_quoted(directory.string());
  const bool physics = result.code == ExitCode::physics;
  if (physics && result.error.find(kNoStepHelps) != std::string::npos)
    std::fputs("furrow: a resumed run would fail at the same step; start again with furrow run --overwrite\n", stderr);
  else if (checkpoint::list_checkpoints(directory).empty())
    std::fprintf(stderr, "furrow: there is no checkpoint yet; start again with furrow run --overwrite%s\n",
                 physics ? ", perhaps with a smaller run.step" : "");
  else if (physics)
    std::fprintf(stderr,
                 "furrow: a resumed run would fail at the same step; to continue from the last checkpoint with a "
                 "smaller step: furrow resume %s --set run.step=%s\n",
                 folder.c_str(), number_text(0.5 * scenario.run.step).c_str());
  else
    std::fprintf(stderr, "furrow: to continue from the last checkpoint: furrow resume %s\n", folder.c_str());
}

/// Time when the file was written; the earliest time if it does not exist.
std::filesystem::file_time_type written(const std::filesystem::path& file) {
  std::error_code error;
  const auto at = std::filesystem::last_write_time(file, error);
  return error ? std::filesystem::file_time_type::min() : at;
}

/// Prints why a run ended that leaves no files. @param what  happened to the folder
void tell_end(const launch::LaunchResult& result, const std::string& what) {
  if (result.code == ExitCode::stopped)
    std::fprintf(stderr, "furrow: %s\n", result.error.c_str());
  else
    print_error(result.error);
  std::fprintf(stderr, "furrow: %s\n", what.c_str());
}

/// Writes summary_failed.json of a run whose rig could not write it: the reason, without means.
void write_failure(const std::filesystem::path& file, const scenario::Scenario& scenario,
                   const launch::LaunchResult& result) {
  const nlohmann::ordered_json json{
      {"format_version", 1},
      {"version", FURROW_VERSION},
      {"scenario", scenario.name},
      {"scenario_digest", scenario.digest},
      {"failed", {{"exit_code", static_cast<int>(result.code)}, {"error", result.error}, {"time_s", nullptr}}}};
  try {
    write_whole_file(file, json.dump(2) + "\n");
  } catch (const Error&) {
    // The failure itself is reported. Its text or the next command reports a full disk.
  }
}

ExitCode supervise_run(const scenario::Scenario& scenario, launch::RunDirectory& directory,
                       const RunArguments& arguments) {
  launch::LaunchResult result;
  const std::filesystem::path failed = directory.path() / "summary_failed.json";
  const auto failed_before = written(failed), done_before = written(directory.path() / kDone);
  try {
    launch::ProgressDisplay display;
    result = supervise_ranks(scenario, directory, arguments, display);
  } catch (const Error&) {
    directory.discard();
    throw;
  }
  if (!directory.lock().stands()) {  // the run's files are not at its path
    print_error(result.error.empty() ? directory.path().string() + ": was moved or removed as the run ended"
                                     : result.error);
    return result.code == ExitCode::done ? ExitCode::io : result.code;
  }
  const bool finished = result.code != ExitCode::done && written(directory.path() / kDone) > done_before;
  if (finished && result.code == ExitCode::io) {  // the final checkpoint is missing
    tell_result(scenario, directory.path(), arguments.plots);
    print_error(result.error);
    std::cout << directory.path().string() << "\n";
    return result.code;
  }
  if (finished) {
    print_warning("the run had finished before this happened: " + result.error);
    result.code = ExitCode::done;
  }
  const bool nothing_done = result.code == ExitCode::limit && result.started == 0;
  const bool replaces = result.code != ExitCode::done && directory.replaces();
  if (result.code == ExitCode::bad_input || nothing_done || replaces) directory.discard();
  if (replaces && result.code != ExitCode::bad_input) {
    tell_end(result,
             "the run had not begun to step; " + directory.path().string() + " holds the earlier results again");
    return result.code;
  }
  const bool finished_before = result.code != ExitCode::done && result.code != ExitCode::bad_input &&
                               done_before != std::filesystem::file_time_type::min() &&
                               written(directory.path() / kDone) == done_before &&
                               checkpoint::finished_at(directory.path()) >= 0;
  if (finished_before) {
    tell_end(result, "the run had not gone on; " + directory.path().string() + " is finished as it was");
    return result.code;
  }
  if (result.code == ExitCode::stopped) {
    std::fprintf(stderr, "furrow: %s; partial results are in %s\n", result.error.c_str(), directory.path().c_str());
    tell_how_to_continue(directory.path(), result, scenario);
  } else if (result.code != ExitCode::done) {
    print_error(result.error);
    if (result.code != ExitCode::bad_input && !nothing_done) {
      const bool measured = written(failed) != failed_before;
      if (!measured) write_failure(failed, scenario, result);
      std::fprintf(stderr, "furrow: the log of the ranks is %s\n", (directory.path() / "run.log").c_str());
      if (measured) std::fprintf(stderr, "furrow: what was measured until then is in %s\n", failed.c_str());
      tell_how_to_continue(directory.path(), result, scenario);
    }
    return result.code;
  } else {
    tell_result(scenario, directory.path(), arguments.plots);
  }
  std::cout << directory.path().string() << "\n";
  return result.code;
}

/// srun without MPI starts as many supervisors as ranks, which would compete for the folder.
void refuse_tasks_without_mpi() {
  const char* tasks = std::getenv("SLURM_STEP_NUM_TASKS");
  if (!tasks || std::atoi(tasks) < 2) return;
  const char* task = std::getenv("SLURM_PROCID");
  const Error error = input_error(
      "srun", "",
      "started {} tasks without MPI, expected srun --mpi=pmix, or furrow run without srun, which starts its own ranks",
      tasks);
  if (task && std::atoi(task) > 0 && first_rank_speaks()) std::exit(static_cast<int>(error.code()));
  throw error;
}

ExitCode run_supervised(const RunArguments& arguments) {
  refuse_tasks_without_mpi();
  const scenario::Scenario scenario = scenario::load_scenario(arguments.scenario, arguments.settings);
  for (const std::string& warning : scenario.warnings) print_warning(warning);
  require_launch(scenario);
  launch::RunDirectory directory(scenario.name, arguments.out, arguments.overwrite, arguments.scenario);
  launch::catch_stop_signals();
  launch::say("furrow: {}, results in {}\n", scenario.name, directory.path().string());
  return supervise_run(scenario, directory, arguments);
}

ExitCode resume_supervised(const RunArguments& arguments) {
  refuse_tasks_without_mpi();
  launch::RunDirectory directory(arguments.out);
  if (const std::string restored = checkpoint::restore_scenario(directory.path()); !restored.empty())
    print_warning(restored);
  const checkpoint::ResumePlan plan = checkpoint::plan_resume(directory.path(), arguments.settings);
  for (const auto* warnings : {&plan.scenario.warnings, &plan.warnings})
    for (const std::string& warning : *warnings) print_warning(warning);
  if (plan.finished) {
    tell_finished(directory.path(), plan.ended);
    return ExitCode::done;
  }
  require_launch(plan.scenario);
  launch::catch_stop_signals();
  launch::say("furrow: continuing {} from t = {:g} s, results in {}\n", plan.scenario.name, plan.point.manifest.time,
              directory.path().string());
  return supervise_run(plan.scenario, directory, arguments);
}

ExitCode run(RunArguments arguments, const Typed& typed) {
  arguments.scenario = typed.scenario;
  arguments.settings = settings_of(typed);
  if (arguments.seeds) return run_on_beds(arguments);
  if (arguments.jobs)
    throw input_error("command line", "--jobs", "is given without --seeds, expected both: one bed is one job");
  return launched_by_mpi() ? run_as_rank(arguments, typed.argc, typed.argv) : run_supervised(arguments);
}

ExitCode resume(RunArguments arguments, const Typed& typed) {
  arguments.settings = settings_of(typed);
  arguments.resume = true;
  return launched_by_mpi() ? run_as_rank(arguments, typed.argc, typed.argv) : resume_supervised(arguments);
}

Action run_options(CLI::App& command, Typed& typed) {
  const auto arguments = std::make_shared<RunArguments>();
  add_scenario(command, typed);
  add_folder_options(command, arguments->out, arguments->overwrite, "<scenario>-NNN");
  command.add_flag("--profile", arguments->profile,
                   "Write profile.json too: where the time of each step goes (Chrome trace).");
  add_no_plots(command, arguments->plots);
  command.add_option("--seeds", arguments->seeds,
                     "Run on this number of beds, 2 to 1000, with run.seed, run.seed + 1, …, and write means and 95 % "
                     "intervals. The same command continues interrupted ones.");
  command.add_option(
      "--jobs", arguments->jobs,
      "Run this number of beds at once, each with its share of the cores (default: 1). It needs --seeds.");
  return [arguments, &typed] { return run(*arguments, typed); };
}

Action resume_options(CLI::App& command, Typed& typed) {
  const auto arguments = std::make_shared<RunArguments>();
  command.add_option("DIR", arguments->out, "Continue the run in this folder.")->required();
  command.add_option("--until", typed.until, "Run until this simulated time, s (run.end).");
  add_settings(command, typed);
  command.add_flag("--profile", arguments->profile, "Write profile.json too, of the steps from here on.");
  add_no_plots(command, arguments->plots);
  return [arguments, &typed] { return resume(*arguments, typed); };
}

}  // namespace

launch::LaunchResult supervise_ranks(const scenario::Scenario& scenario, launch::RunDirectory& directory,
                                     const RunArguments& arguments, launch::ProgressDisplay& display) {
  directory.add({"run.log", "summary_failed.json"});
  directory.lock().share();
  return launch::supervise(
      {rank_arguments(arguments, directory.path()), scenario::rank_table(scenario),
       scenario.terrain_ranks > 1 ? static_cast<std::size_t>(scenario.terrain_ranks) : 0, directory.path() / "run.log",
       directory.lock().descriptor(), launch::start_patience(), scenario.run.peer_timeout},
      display);
}

void require_launch(const scenario::Scenario& scenario) {
  scenario::require_runnable(scenario);
  scenario::require_memory(scenario);
  launch::start_patience();
  launch::find_mpirun();
  launch::require_files(scenario::rank_table(scenario).size());
}

void tell_finished(const std::filesystem::path& run, double ended) {
  launch::say("furrow: {} is finished: it ended at {:g} s; there is nothing to do\n", run.string(), ended);
  std::cout << run.string() << std::endl;
}

Command run_entry() {
  return {
      .name = "run",
      .task = task::run,
      .purpose = "Run a scenario and print the folder that holds the results.",
      .options = run_options,
      .examples = {{"run first_look.json", "Run a wheel on soil, in seconds."},
                   {"run drawbar_pull_small.json --set rig.slip=0.2 --seeds 5", "Get pull and sinkage with intervals."},
                   {"run rigid_ground.json --out hard --overwrite", "Choose the folder of the results."}}};
}

Command resume_entry() {
  return {.name = "resume",
          .task = task::run,
          .purpose =
              "Continue a run from its last checkpoint. The result is bit-identical to that of an uninterrupted run.",
          .options = resume_options,
          .examples = {{"resume results/first_look-001", "Go to the end that the scenario gives."},
                       {"resume results/first_look-001 --until 3", "Lengthen a finished run to 3 s."}}};
}

}  // namespace furrow::commands
