// `furrow validate` and `furrow ranks`: what a run will need, and which ranks it has.
#include <algorithm>
#include <iostream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "nodes/calibrate/study.hpp"
#include "nodes/commands/questions.hpp"
#include "nodes/commands/wrapped.hpp"
#include "nodes/scenario/machine_speed.hpp"
#include "nodes/scenario/rank_table.hpp"
#include "nodes/scenario/run_time.hpp"
#include "nodes/scenario/runnable.hpp"
#include "nodes/scenario/validate.hpp"
#include "nodes/scenario/vehicle_tires.hpp"

namespace furrow::commands {

ExitCode validate_command(Typed& typed) {
  const bool vehicle = scenario::is_vehicle(typed.scenario),
             calibration = !vehicle && calibrate::is_calibration(typed.scenario);
  if (vehicle || calibration) {
    if (!settings_of(typed).empty())
      throw input_error("command line", typed.threads.empty() ? "--set" : "--threads",
                        fmt::format("is given with {}, expected a scenario",
                                    vehicle ? "the file of a vehicle" : "a calibration study"));
    return vehicle ? validate_vehicle(typed.scenario, typed.json) : validate_calibration(typed.scenario, typed.json);
  }
  const scenario::Scenario scenario = load(typed);
  scenario::require_runnable(scenario);
  const scenario::RunTime time = scenario::run_time(scenario, scenario::machine_speed());
  if (typed.json)
    std::cout << scenario::validation_report(scenario, &time).dump(2) << "\n";
  else
    print_text(scenario::validation_text(scenario, &time), Piped::whole_lines);
  return ExitCode::done;
}

ExitCode ranks_command(Typed& typed, const SlurmArguments& slurm, const std::vector<std::string>& command_line) {
  const scenario::Scenario scenario = load(typed);
  scenario::require_runnable(scenario);
  if (typed.slurm) {
    std::cout << slurm_script(scenario, slurm, settings_of(typed));
    return ExitCode::done;
  }
  std::vector<std::string> arguments = command_line;
  *std::find(arguments.begin(), arguments.end(), "ranks") = "run";
  std::cout << scenario::rank_table_text(scenario) << "\n" << scenario::launch_lines(scenario, arguments);
  return ExitCode::done;
}

}  // namespace furrow::commands
