// `furrow soil`: virtual soil tests on a scenario's grains.
#include <algorithm>
#include <iostream>
#include <memory>

#include <fmt/format.h>

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
  std::filesystem::path out;  // empty: a new folder under results/
  bool overwrite = false;
  bool quick = false;
  int seeds = 3;
  double speed = 0.1;                                // of the tools, m/s
  std::vector<std::string> only;                     // tests; empty: all but the interface test
  double friction = -1.0;                            // of the interface test, -; negative: same as between grains
  std::vector<double> stresses;                      // of the shear tests, Pa; empty: the usual ones
  std::vector<double> discs, strips, cones, depths;  // m; empty: sizes in grain radii
  double sinkage = 0.0, bed_width = 0.0;             // m; 0: by soil_plan()
  bool own_bed = false;
};

constexpr double kMostGrains = 5e6;    // of a bed
constexpr double kGrainSteps = 3e6;    // per second of one core, approximately
constexpr double kManySteps = 1e10;    // about an hour
constexpr double kLeastPlate = 5.0;    // diameters of a grain across a plate
constexpr double kLeastSinkage = 1.2;  // diameters of a grain: fits of curves begin at one diameter

void check_metres(const terrain::dem::DemOptions& grains, const SoilArguments& a) {
  const auto each = [](const char* option, const std::vector<double>& sizes) {
    for (const double size : sizes)
      require_option(size > 0.0 && size <= 10.0, option, "is " + number_text(size) + " m, expected above 0 up to 10 m");
  };
  each("--disc", a.discs), each("--strip", a.strips), each("--cone", a.cones), each("--depth", a.depths);
  const bool plates = !a.discs.empty() || !a.strips.empty();
  require_option(!a.quick || (!plates && a.cones.empty()), "--quick",
                 "has small boxes, expected it without --disc, --strip and --cone");
  require_option(plates || !a.cones.empty() || a.depths.empty(), "--depth",
                 "is the depth of beds for plates and cones in metres, expected it with --disc, --strip or --cone");
  require_option(plates || a.sinkage == 0.0, "--sinkage", "is that of plates in metres, expected --disc or --strip");
  require_option(plates || !a.cones.empty() || a.bed_width == 0.0, "--bed-width",
                 "is that of beds for plates and cones in metres, expected --disc, --strip or --cone");
  const double diameter = 2.0 * grains.radius;
  for (const auto& [option, sizes] : {std::pair{"--disc", &a.discs}, {"--strip", &a.strips}})
    for (const double size : *sizes)
      if (size < kLeastPlate * diameter)
        print_warning(fmt::format("{} {}: only {:.2g} grains across, expected {} or more", option, number_text(size),
                                  size / diameter, kLeastPlate));
  if (!plates) return;
  double least = 10.0, most = 0.0, shallow = 10.0;
  for (const auto* sizes : {&a.discs, &a.strips})
    for (const double size : *sizes) least = std::min(least, size), most = std::max(most, size);
  for (const double depth : a.depths) shallow = std::min(shallow, depth);
  const double sinkage = a.sinkage > 0.0 ? a.sinkage : terrain::soil::kSinkage * least;
  require_option(sinkage >= kLeastSinkage * diameter, "--sinkage",
                 fmt::format("is {} m, expected {:.3g} m or more: curves count from the diameter of a grain on",
                             number_text(sinkage), kLeastSinkage * diameter));
  if (!a.own_bed && !a.depths.empty())
    require_option(sinkage < 0.5 * shallow, "--sinkage",
                   fmt::format("is {} m, expected less than half of the depth of the bed, {} m", number_text(sinkage),
                               number_text(shallow)));
  require_option(a.bed_width == 0.0 || a.bed_width > 2.0 * most, "--bed-width",
                 fmt::format("is {} m, expected more than twice the largest plate, {} m", number_text(a.bed_width),
                             number_text(most)));
}

void check_own_bed(const scenario::Scenario& scenario, const terrain::dem::DemOptions& grains, const SoilArguments& a) {
  if (!a.own_bed) return;
  require_option(!a.quick, "--quick", "has small boxes, expected it without --own-bed");
  require_option(a.depths.empty() && a.bed_width == 0.0, "--own-bed",
                 "takes the bed as it is, expected it without --depth and --bed-width");
  require_option(a.strips.empty() || grains.periodic_y(), "--strip",
                 "spans the bed, expected --disc, or a scenario with terrain.sides 'periodic'");
  const auto fit = [&](const char* option, const std::vector<double>& sizes) {
    const double least = std::min(grains.length, grains.width);
    for (const double size : sizes) {
      require_option(
          size < 0.9 * least, option,
          fmt::format("is {} m, expected less than 0.9 of the bed's {} m", number_text(size), number_text(least)));
      if (size * terrain::soil::kWidths > 1.001 * least)
        print_warning(
            fmt::format("{} {}: the bed of {} is {:.2g} sizes wide, expected {} or more where its sides "
                        "shall not count",
                        option, number_text(size), scenario.name, least / size, terrain::soil::kWidths));
    }
  };
  fit("--disc", a.discs), fit("--cone", a.cones);
}

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
  o.discs = arguments.discs, o.strips = arguments.strips, o.cones = arguments.cones, o.depths = arguments.depths;
  o.sinkage = arguments.sinkage, o.bed_width = arguments.bed_width, o.own_bed = arguments.own_bed;
  if (!o.own_bed) return o;
  require_option(only.empty() || !(o.shear || o.repose || o.interface), "--only",
                 "names a test that needs a box of its own, expected plate or cone with --own-bed");
  o.shear = o.repose = false;
  const bool plates = !o.discs.empty() || !o.strips.empty();
  require_option(only.empty() || !o.plate || plates, "--own-bed", "expected --disc, the size of the plate, m");
  o.plate &= plates;
  o.cone &= !only.empty() || !o.cones.empty();  // cones in grain radii may be too large for the bed
  require_option(o.plate || o.cone, "--own-bed", "expected --disc or --cone, the size of what is pushed in, m");
  o.seeds = grains.bed.empty() ? o.seeds : 1;  // a file has only one bed
  return o;
}

void check_work(const terrain::soil::SoilWork& work, int threads) {
  if (work.grains > kMostGrains)
    throw limit_error(
        fmt::format("the largest bed has about {:.2g} grains, expected at most {:g}: smaller plates, a "
                    "smaller --depth or --bed-width, or a larger terrain.radius",
                    work.grains, kMostGrains));
  if (work.grain_steps > kManySteps)
    print_warning(fmt::format("beds of up to {:.2g} grains: the tests take about {:.2g} core hours on {} threads",
                              work.grains, work.grain_steps / kGrainSteps / 3600.0, threads));
}

/// Shows share and time left; ends the tests if a signal asks for a stop.
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
  check_metres(grains, arguments);
  check_own_bed(scenario, grains, arguments);
  const terrain::soil::SoilOptions options = soil_options(grains, arguments);
  const terrain::soil::SoilPlan plan = terrain::soil::soil_plan(options);
  if (!grains.bed.empty() && !arguments.own_bed)
    print_warning(input_error(scenario.file.string(), "terrain.bed",
                              "is not what is tested: the tests make small beds of the same grains; --own-bed tests it")
                      .what());
  check_work(terrain::soil::soil_work(options, plan), options.threads);
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
    launch::say(terrain::soil::soil_text(soil));  // before the files, because the disk may be full
    std::cout << soil.dump(2) << std::endl;
    directory.add({"scenario.json", "soil.json", "plate.csv", "shear.csv", "cone.csv", "cones.csv", "repose.csv",
                   "interface.csv"});
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
  const auto sizes = [&](const char* option, std::vector<double>& to, const char* text) {
    command.add_option(option, to, text)->take_all()->allow_extra_args(false);
  };
  sizes("--disc", arguments->discs,
        "Push in a disc of this diameter, m, instead of strips in grain radii. The option may be repeated.");
  sizes("--strip", arguments->strips,
        "Push in a strip of this width, m, instead of those in grain radii. The option may be repeated.");
  sizes("--cone", arguments->cones,
        "Push in a cone of this base diameter, m, instead of those in grain radii; 0.02027 and 0.01283 are the "
        "standard's. The option may be repeated.");
  sizes("--depth", arguments->depths,
        "Make the beds of plates and cones in metres this deep, m (default: three times the largest plate). Repeat "
        "the option for beds of several depths.");
  command.add_option("--sinkage", arguments->sinkage,
                     "Push discs and strips in by this much, m (default: a quarter of the smallest).");
  command.add_option("--bed-width", arguments->bed_width,
                     "Make the beds of plates and cones in metres this long and wide, m; they are periodic (default: "
                     "five times the largest disc, ten times the largest strip, six times the largest cone).");
  command.add_flag("--own-bed", arguments->own_bed,
                   "Test the scenario's own bed (of terrain.bed, the cache, or settled now) with --disc and cones in "
                   "its middle, instead of beds of its grains.");
  command.add_flag("--quick", arguments->quick,
                   "Use small boxes and one seed, for an impression within seconds. Do not quote its results.");
  return [arguments, &typed] { return test_soil(load(typed, scenario::Purpose::soil_tests), *arguments); };
}

}  // namespace

Command soil_entry() {
  return {
      .name = "soil",
      .task = task::test,
      .purpose =
          "Run virtual soil tests on a scenario's grains (plate sinkage, direct shear, cone, angle of repose) and "
          "print the results as JSON.",
      .options = soil_options,
      .examples = {{"soil drawbar_pull_small.json --quick", "Get an impression within seconds."},
                   {"soil drawbar_pull_small.json --only shear", "Measure cohesion and friction angle on three beds."},
                   {"soil small_wheel.json --only plate --disc 0.06 --disc 0.1 --depth 0.15 --sinkage 0.02",
                    "Press discs as a bevameter has them, and account for the volume that they displace."}}};
}

}  // namespace furrow::commands
