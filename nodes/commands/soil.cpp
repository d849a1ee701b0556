// `furrow soil`: virtual soil tests on a scenario's grains.
#include <algorithm>
#include <iostream>
#include <memory>

#include "nodes/commands/command_table.hpp"
#include "nodes/launch/messages.hpp"
#include "nodes/launch/progress.hpp"
#include "nodes/launch/run_directory.hpp"
#include "nodes/launch/signals.hpp"
#include "nodes/scenario/scenario.hpp"
#include "protocol/core/clock.hpp"
#include "protocol/files/json_text.hpp"
#include "protocol/files/text_file.hpp"
#include "terrain/soil/soil_output.hpp"

namespace furrow::commands {
namespace {

struct SoilArguments {
  std::filesystem::path out;  // empty: a fresh folder under results/
  bool overwrite = false;
  bool quick = false;
  int seeds = 3;
  double speed = 0.1;             // of the tools, m/s
  std::vector<std::string> only;  // tests; empty: all but that of the interface
  double friction = -1.0;         // of the interface test, -; negative: as among the grains
  std::vector<double> stresses;   // of the shear tests, Pa; empty: the usual ones
};

terrain::soil::SoilOptions soil_options(const terrain::dem::DemOptions& grains, const SoilArguments& arguments) {
  require_option(arguments.seeds >= 1 && arguments.seeds <= 100, "--seeds",
                 "is " + std::to_string(arguments.seeds) + ", expected 1 to 100");
  require_option(arguments.speed > 0.0 && arguments.speed <= 10.0, "--speed", "expected above 0 up to 10 m/s");
  terrain::soil::SoilOptions o;
  o.material = grains;
  o.seeds = arguments.quick ? 1 : arguments.seeds;
  o.speed = arguments.speed;
  o.quick = arguments.quick;
  o.threads = grains.settle_threads;
  o.stresses = arguments.stresses;
  std::sort(o.stresses.begin(), o.stresses.end());
  for (const double stress : o.stresses)
    require_option(stress > 0.0 && stress <= 1e7, "--stress",
                   "is " + number_text(stress) + " Pa, expected above 0 up to 1e7 Pa");
  require_option(o.stresses.empty() || o.stresses.front() < o.stresses.back(), "--stress",
                 o.stresses.size() == 1
                     ? "is given once, expected two stresses or more: c and φ are of a line through them"
                     : "is the same each time, expected two stresses or more: c and φ are of a line through them");
  const auto& only = arguments.only;
  const auto asked = [&](const char* test) {
    return only.empty() || std::find(only.begin(), only.end(), test) != only.end();
  };
  for (const std::string& test : only)
    require_option(test == "plate" || test == "shear" || test == "cone" || test == "repose" || test == "interface",
                   "--only", "is '" + test + "', expected plate, shear, cone, repose or interface");
  o.interface = !only.empty() && asked("interface");
  o.face_friction = arguments.friction;
  require_option(arguments.friction == -1.0 || (arguments.friction >= 0.0 && arguments.friction <= 10.0), "--friction",
                 "expected 0 to 10");
  o.plate = asked("plate"), o.shear = asked("shear"), o.cone = asked("cone"), o.repose = asked("repose");
  return o;
}

/// Shows share and time left; ends the tests when a signal asks for it.
ProgressCall shown_on(launch::ProgressDisplay& display) {
  return [&display, begin = wall_clock()](const std::string& what, double share) {
    if (launch::stop_signalled()) throw Error(ExitCode::stopped, "stopped by a signal during the soil tests");
    launch::Progress progress{.phase = what, .share = share};
    if (share > 0.0) progress.eta = (wall_clock() - begin) * (1.0 - share) / share;  // of all tests
    display.show(progress);
  };
}

ExitCode test_soil(const scenario::Scenario& scenario, const SoilArguments& arguments) {
  const terrain::dem::DemOptions grains = scenario.grains("only grains can be tested");
  const terrain::soil::SoilOptions options = soil_options(grains, arguments);
  const terrain::soil::SoilPlan plan = terrain::soil::soil_plan(options);
  if (!grains.bed.empty())
    print_warning(input_error(scenario.file.string(), "terrain.bed",
                              "is not what is tested: the tests make small beds of the same grains")
                      .what());
  launch::RunDirectory directory(scenario.name + "-soil", arguments.out, arguments.overwrite);
  launch::catch_stop_signals();
  launch::say("furrow: soil tests of {}, results in {}\n", scenario.name, directory.path().string());
  try {
    launch::ProgressDisplay display;
    const double begin = wall_clock();
    const terrain::soil::SoilResults results = terrain::soil::run_soil_tests(options, plan, shown_on(display));
    display.clear();
    const terrain::soil::SoilRun run{scenario.name, scenario.digest, options, plan, results, wall_clock() - begin};
    const nlohmann::ordered_json soil = terrain::soil::soil_json(run);
    launch::say(terrain::soil::soil_text(soil));  // before the files: the disk may be full
    std::cout << soil.dump(2) << std::endl;
    directory.add({"scenario.json", "soil.json", "plate.csv", "shear.csv", "cone.csv", "repose.csv", "interface.csv"});
    write_whole_file(directory.path() / "scenario.json", scenario.completed + "\n");
    terrain::soil::write_soil_tables(directory.path(), run);
    write_whole_file(directory.path() / "soil.json", soil.dump(2) + "\n");
  } catch (...) {
    directory.discard();
    throw;
  }
  make_report_or_warn(directory.path());
  return ExitCode::done;
}

Action soil_options(CLI::App& command, Typed& typed) {
  const auto arguments = std::make_shared<SoilArguments>();
  add_scenario(command, typed);
  add_folder_options(command, arguments->out, arguments->overwrite, "<scenario>-soil-NNN");
  command
      .add_option("--seeds", arguments->seeds,
                  "Repeat each test on this number of beds, with run.seed, run.seed + 1, …")
      ->capture_default_str();
  command.add_option("--speed", arguments->speed, "Move plate, shear box and cone at this speed, m/s.")
      ->capture_default_str();
  command
      .add_option("--only", arguments->only,
                  "Run this test only: plate, shear, cone, repose or interface (grains along a plate, which is not run "
                  "otherwise). The option may be repeated.")
      ->take_all()
      ->allow_extra_args(false);
  command
      .add_option("--stress", arguments->stresses,
                  "Shear under this normal stress, Pa. Repeat the option: two stresses or more are needed (default: "
                  "20, 50 and 100 kPa, less for soft grains).")
      ->take_all()
      ->allow_extra_args(false);
  command.add_option("--friction", arguments->friction,
                     "Coulomb coefficient between the grains and the plate of the interface test (default: as among "
                     "the grains).");
  command.add_flag("--quick", arguments->quick,
                   "Use small boxes and one seed, for an impression within seconds. Do not quote its results.");
  return [arguments, &typed] { return test_soil(load(typed), *arguments); };
}

}  // namespace

Command soil_entry() {
  return {.name = "soil",
          .task = task::test,
          .purpose =
              "Run virtual soil tests on a scenario's grains (plate sinkage, direct shear, cone, angle of repose) and "
              "print the results as JSON.",
          .options = soil_options,
          .examples = {
              {"soil drawbar_pull_small.json --quick", "Get an impression within seconds."},
              {"soil drawbar_pull_small.json --only shear", "Measure cohesion and friction angle on three beds."}}};
}

}  // namespace furrow::commands
