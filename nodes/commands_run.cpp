// `furrow run` outside MPI: checks first, then has the ranks started and watched, then tells the result.
#include <cstdio>
#include <iostream>

#include <fmt/format.h>

#include "nodes/commands.hpp"
#include "nodes/run_directory.hpp"
#include "nodes/scenario.hpp"
#include "nodes/signals.hpp"
#include "nodes/supervisor.hpp"

namespace furrow {
namespace {

std::vector<std::string> rank_arguments(const RunArguments& arguments,
                                        const std::filesystem::path& directory) {
  std::vector<std::string> list{"run", arguments.scenario.string(), "--out", directory.string()};
  for (const auto& [key, value] : arguments.settings) {
    list.push_back("--set");
    list.push_back(key + "=" + value);
  }
  if (arguments.profile) list.push_back("--profile");
  return list;
}

void tell_result(const Scenario& scenario, const std::filesystem::path& directory) {
  std::fputs(result_text(directory, scenario).c_str(), stderr);
  try {
    const auto plots = make_report(directory, true);
    if (!plots.empty())
      std::fprintf(stderr, "furrow: plots: %s and %zu more\n", plots.front().c_str(), plots.size() - 1);
  } catch (const Error& error) {
    print_warning(std::string("no plots: ") + error.what());
  }
}

}  // namespace

ExitCode run_supervised(const RunArguments& arguments) {
  const Scenario scenario = load_scenario(arguments.scenario, arguments.settings);
  for (const std::string& warning : scenario.warnings) print_warning(warning);
  find_mpirun();
  RunDirectory directory(scenario.name, arguments.out, arguments.overwrite);
  catch_stop_signals();
  std::fprintf(stderr, "furrow: %s, results in %s\n", scenario.name.c_str(), directory.path().c_str());

  LaunchResult result;
  {
    ProgressDisplay display;
    result = supervise(
        {rank_arguments(arguments, directory.path()), rank_table(scenario), directory.path() / "run.log"},
        display);
  }
  if (result.code == ExitCode::bad_input) directory.discard();
  if (result.code == ExitCode::stopped) {
    std::fprintf(stderr, "furrow: %s; what there is of the results stands in %s\n", result.error.c_str(),
                 directory.path().c_str());
  } else if (result.code != ExitCode::done) {
    print_error(result.error);
    if (result.code != ExitCode::bad_input)
      std::fprintf(stderr, "furrow: what the ranks said stands in %s\n",
                   (directory.path() / "run.log").c_str());
    return result.code;
  } else {
    tell_result(scenario, directory.path());
  }
  std::cout << directory.path().string() << "\n";
  return result.code;
}

}  // namespace furrow
