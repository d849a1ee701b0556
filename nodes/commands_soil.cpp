// `furrow soil`: virtual soil tests on a scenario's grains.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <iostream>

#include "nodes/commands.hpp"
#include "nodes/progress.hpp"
#include "nodes/run_directory.hpp"
#include "nodes/scenario.hpp"
#include "nodes/signals.hpp"
#include "nodes/soil_output.hpp"
#include "nodes/text_file.hpp"

namespace furrow {
namespace {

double wall_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

soil::SoilOptions soil_options(const Scenario& scenario, const SoilArguments& arguments) {
  const auto require = [](bool ok, const char* key, const std::string& what) {
    if (!ok) throw input_error("command line", key, what);
  };
  require(arguments.seeds >= 1 && arguments.seeds <= 100, "--seeds",
          "is " + std::to_string(arguments.seeds) + ", expected 1 to 100");
  require(arguments.speed > 0.0 && arguments.speed <= 10.0, "--speed", "expected above 0 up to 10 m/s");
  soil::SoilOptions o;
  o.material = scenario.terrain;
  o.seeds = arguments.quick ? 1 : arguments.seeds;
  o.speed = arguments.speed;
  o.quick = arguments.quick;
  o.threads = scenario.terrain.settle_threads;
  const auto& only = arguments.only;
  const auto asked = [&](const char* test) {
    return only.empty() || std::find(only.begin(), only.end(), test) != only.end();
  };
  for (const std::string& test : only)
    require(test == "plate" || test == "shear" || test == "cone" || test == "repose", "--only",
            "is '" + test + "', expected plate, shear, cone or repose");
  o.plate = asked("plate"), o.shear = asked("shear"), o.cone = asked("cone"), o.repose = asked("repose");
  return o;
}

/// Shows share and time left; ends the tests when a signal asks for it.
ProgressCall shown_on(ProgressDisplay& display) {
  return [&display, begin = wall_s()](const std::string& what, double share) {
    if (stop_signalled()) throw Error(ExitCode::stopped, "stopped by a signal during the soil tests");
    Progress progress{.phase = what, .share = share};
    if (share > 0.0) progress.eta = (wall_s() - begin) * (1.0 - share) / share;
    display.show(progress);
  };
}

}  // namespace

ExitCode soil_command(const Scenario& scenario, const SoilArguments& arguments) {
  require_grains(scenario, "only grains can be tested");
  const soil::SoilOptions options = soil_options(scenario, arguments);
  const soil::SoilPlan plan = soil::soil_plan(options);
  if (!scenario.terrain.bed.empty())
    print_warning(input_error(scenario.file.string(), "terrain.bed",
                              "is not what is tested: the tests make small beds of the same grains")
                      .what());
  RunDirectory directory(scenario.name + "-soil", arguments.out, arguments.overwrite);
  catch_stop_signals();
  std::fprintf(stderr, "furrow: soil tests of %s, results in %s\n", scenario.name.c_str(),
               directory.path().c_str());
  try {
    ProgressDisplay display;
    const double begin = wall_s();
    const soil::SoilResults results = run_soil_tests(options, plan, shown_on(display));
    display.clear();
    const SoilRun run{scenario, options, plan, results, wall_s() - begin};
    const nlohmann::ordered_json soil = soil_json(run);
    write_whole_file(directory.path() / "scenario.json", scenario.completed + "\n");
    write_soil_tables(directory.path(), run);
    write_whole_file(directory.path() / "soil.json", soil.dump(2) + "\n");
    std::fputs(soil_text(soil).c_str(), stderr);
    std::cout << soil.dump(2) << "\n";
  } catch (const Error&) {
    directory.discard();
    throw;
  }
  make_report_or_warn(directory.path());
  return ExitCode::done;
}

}  // namespace furrow
