// `furrow run` and `furrow resume` outside MPI: check first, then have the ranks started and watched, then tell the
// result.
#include <cstdio>
#include <iostream>

#include <fmt/format.h>

#include "nodes/checkpoint/checkpoint.hpp"
#include "nodes/checkpoint/resume.hpp"
#include "nodes/commands/commands.hpp"
#include "nodes/launch/run_directory.hpp"
#include "nodes/launch/signals.hpp"
#include "nodes/launch/supervisor.hpp"
#include "nodes/scenario/load_scenario.hpp"

namespace furrow::commands {
namespace {

std::vector<std::string> rank_arguments(const RunArguments& arguments,
                                        const std::filesystem::path& directory) {
  std::vector<std::string> list{"run", arguments.scenario.string(), "--out", directory.string()};
  if (arguments.resume) list = {"resume", directory.string()};
  for (const auto& [key, value] : arguments.settings) {
    list.push_back("--set");
    list.push_back(key + "=" + value);
  }
  if (arguments.profile) list.push_back("--profile");
  return list;
}

void tell_result(const scenario::Scenario& scenario, const std::filesystem::path& directory, bool plots) {
  std::fputs(result_text(directory, scenario).c_str(), stderr);
  if (!plots) return;
  const auto made = make_report_or_warn(directory);
  if (!made.empty())
    std::fprintf(stderr, "furrow: plots: %s and %zu more\n", made.front().c_str(), made.size() - 1);
}

/// What can be done with a run that did not come to its end.
void tell_how_to_continue(const std::filesystem::path& directory) {
  if (checkpoint::list_checkpoints(directory).empty())
    std::fprintf(stderr, "furrow: there is no checkpoint yet; start again with furrow run\n");
  else
    std::fprintf(stderr, "furrow: to continue from the last checkpoint: furrow resume %s\n",
                 scenario::shell_quoted(directory.string()).c_str());
}

ExitCode supervise_run(const scenario::Scenario& scenario, launch::RunDirectory& directory,
                       const RunArguments& arguments) {
  launch::LaunchResult result;
  try {
    directory.add({"run.log"});
    directory.lock().share();
    launch::ProgressDisplay display;
    result = launch::supervise({rank_arguments(arguments, directory.path()), scenario::rank_table(scenario),
                                directory.path() / "run.log", directory.lock().descriptor()},
                               display);
  } catch (const Error&) {
    directory.discard();
    throw;
  }
  if (!directory.lock().stands()) {  // what there is of the run is not where its path says
    print_error(result.error.empty() ? directory.path().string() + ": was moved or removed as the run ended"
                                     : result.error);
    return result.code == ExitCode::done ? ExitCode::io : result.code;
  }
  if (result.code == ExitCode::bad_input) directory.discard();
  if (result.code == ExitCode::stopped) {
    std::fprintf(stderr, "furrow: %s; partial results are in %s\n", result.error.c_str(),
                 directory.path().c_str());
    tell_how_to_continue(directory.path());
  } else if (result.code != ExitCode::done) {
    print_error(result.error);
    if (result.code != ExitCode::bad_input) {
      std::fprintf(stderr, "furrow: the log of the ranks is %s\n", (directory.path() / "run.log").c_str());
      tell_how_to_continue(directory.path());
    }
    return result.code;
  } else {
    tell_result(scenario, directory.path(), arguments.plots);
  }
  std::cout << directory.path().string() << "\n";
  return result.code;
}

}  // namespace

ExitCode run_supervised(const RunArguments& arguments) {
  const scenario::Scenario scenario = scenario::load_scenario(arguments.scenario, arguments.settings);
  for (const std::string& warning : scenario.warnings) print_warning(warning);
  launch::find_mpirun();
  launch::RunDirectory directory(scenario.name, arguments.out, arguments.overwrite, arguments.scenario);
  launch::catch_stop_signals();
  std::fprintf(stderr, "furrow: %s, results in %s\n", scenario.name.c_str(), directory.path().c_str());
  return supervise_run(scenario, directory, arguments);
}

ExitCode resume_supervised(const RunArguments& arguments) {
  launch::RunDirectory directory(arguments.out);
  const checkpoint::ResumePlan plan = checkpoint::plan_resume(directory.path(), arguments.settings);
  for (const auto* warnings : {&plan.scenario.warnings, &plan.warnings})
    for (const std::string& warning : *warnings) print_warning(warning);
  if (plan.finished) {
    std::fprintf(stderr, "furrow: %s has come to its end at %g s, there is nothing to do\n",
                 directory.path().c_str(), plan.scenario.run.end);
    std::cout << directory.path().string() << "\n";
    return ExitCode::done;
  }
  launch::find_mpirun();
  launch::catch_stop_signals();
  std::fprintf(stderr, "furrow: continuing %s from t = %g s, results in %s\n", plan.scenario.name.c_str(),
               plan.point.manifest.time, directory.path().c_str());
  return supervise_run(plan.scenario, directory, arguments);
}

}  // namespace furrow::commands
