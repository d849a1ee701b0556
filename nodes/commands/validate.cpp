// `furrow validate` and `furrow ranks`: the needs of a run, and its ranks.
#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "nodes/calibrate/study.hpp"
#include "nodes/commands/command_table.hpp"
#include "nodes/commands/slurm.hpp"
#include "nodes/commands/wrapped.hpp"
#include "nodes/scenario/machine_speed.hpp"
#include "nodes/scenario/rank_table.hpp"
#include "nodes/scenario/run_time.hpp"
#include "nodes/scenario/runnable.hpp"
#include "nodes/scenario/validate.hpp"
#include "nodes/scenario/vehicle_tires.hpp"

namespace furrow::commands {
namespace {

ExitCode validate(Typed& typed, bool json) {
  const bool vehicle = scenario::is_vehicle(typed.scenario),
             calibration = !vehicle && calibrate::is_calibration(typed.scenario);
  if (vehicle || calibration) {
    if (!settings_of(typed).empty())
      throw input_error("command line", typed.threads.empty() ? "--set" : "--threads",
                        "is given with {}, expected a scenario",
                        vehicle ? "the file of a vehicle" : "a calibration study");
    return vehicle ? validate_vehicle(typed.scenario, json) : validate_calibration(typed.scenario, json);
  }
  const scenario::Scenario scenario = load(typed);
  scenario::require_runnable(scenario);
  const scenario::RunTime time = scenario::run_time(scenario, scenario::machine_speed());
  if (json)
    std::cout << scenario::validation_report(scenario, &time).dump(2) << "\n";
  else
    print_text(scenario::validation_text(scenario, &time), Piped::whole_lines);
  return ExitCode::done;
}

ExitCode ranks(Typed& typed, const std::optional<SlurmArguments>& slurm) {
  const scenario::Scenario scenario = load(typed);
  scenario::require_runnable(scenario);
  if (slurm) {
    std::cout << slurm_script(scenario, *slurm, settings_of(typed));
    return ExitCode::done;
  }
  std::vector<std::string> arguments(typed.argv, typed.argv + typed.argc);
  *std::find(arguments.begin(), arguments.end(), "ranks") = "run";
  std::cout << scenario::rank_table_text(scenario) << "\n" << scenario::launch_lines(scenario, arguments);
  return ExitCode::done;
}

Action validate_options(CLI::App& command, Typed& typed) {
  const auto json = std::make_shared<bool>(false);
  add_scenario(command, typed);
  command.get_option("SCENARIO")
      ->description(
          "Check this scenario, vehicle or calibration study (JSON), as given, in rigs/ or in vehicle/data/.");
  command.add_flag("--json", *json, "Print JSON.");
  return [json, &typed] { return validate(typed, *json); };
}

Action ranks_options(CLI::App& command, Typed& typed) {
  const auto slurm = std::make_shared<SlurmArguments>();
  add_scenario(command, typed);
  const CLI::Option* wanted = add_slurm_options(command, *slurm);
  return [slurm, wanted, &typed] { return ranks(typed, *wanted ? std::optional(*slurm) : std::nullopt); };
}

}  // namespace

Command validate_entry() {
  return {.name = "validate",
          .task = task::ask,
          .purpose =
              "Check a scenario and estimate what a run of it will need, check a vehicle and print its state at rest, "
              "or check a calibration study and print what it fits.",
          .options = validate_options,
          .examples = {{"validate drawbar_pull.json", "Learn time, memory and disk of a run before it."},
                       {"validate hmmwv.json", "See axle loads, ride heights and modes."}}};
}

Command ranks_entry() {
  return {.name = "ranks",
          .task = task::ask,
          .purpose = "List which MPI rank does what, and how to start the ranks by hand; or print a batch script.",
          .options = ranks_options,
          .examples = {{"ranks first_look.json", "See which rank does what."},
                       {"ranks drawbar_pull.json --slurm --time 240 > job.sh", "Write a batch script for sbatch."}}};
}

}  // namespace furrow::commands
