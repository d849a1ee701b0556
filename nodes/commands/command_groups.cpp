// The commands and their options, in the groups of the help.
#include <iostream>

#include <fmt/format.h>

#include "nodes/commands/command_line.hpp"
#include "nodes/commands/examples.hpp"
#include "nodes/commands/options.hpp"
#include "nodes/commands/questions.hpp"
#include "nodes/launch/progress.hpp"
#include "nodes/launch/signals.hpp"
#include "protocol/mpi_transport.hpp"

namespace furrow::commands {
namespace {

ExitCode run_command(const Typed& typed, int argc, char** argv) {
  const RunArguments arguments{typed.scenario,  settings_of(typed),      typed.out,
                               typed.overwrite, typed.profile,           !typed.no_plots,
                               false,           typed.seeds.value_or(0), typed.jobs.value_or(1)};
  if (typed.seeds) return run_on_beds(arguments);
  if (typed.jobs)
    throw input_error("command line", "--jobs", "is given without --seeds, expected both: one bed is one job");
  return launched_by_mpi() ? run_as_rank(arguments, argc, argv) : run_supervised(arguments);
}

ExitCode resume_command(const Typed& typed, int argc, char** argv) {
  RunArguments arguments{{}, settings_of(typed), typed.directory, false, typed.profile, !typed.no_plots, true};
  return launched_by_mpi() ? run_as_rank(arguments, argc, argv) : resume_supervised(arguments);
}

template <class Bench>
ExitCode bench_command(std::string (*run)(const Bench&, const ProgressCall&), const Bench& bench) {
  if (const int cores = static_cast<int>(allowed_cores().size()); bench.threads > cores)
    print_warning(fmt::format("--threads {}: this program may use {} cores, more threads than that wait for each other",
                              bench.threads, cores));
  launch::catch_stop_signals();
  launch::ProgressDisplay display;
  const std::string json = run(bench, [&](const std::string& what, double share) {
    if (launch::stop_signalled()) throw Error(ExitCode::stopped, "stopped by a signal during " + what);
    display.show({.phase = what, .share = share});
  });
  display.clear();
  std::cout << json;
  return ExitCode::done;
}

}  // namespace

void CommandLine::add_beginnings() {
  CLI::App& list =
      add("list", "List the scenarios, studies, calibrations, tires, soils and vehicles that come with Furrow.",
          [this] { return list_command(typed_.key, typed_.json); });
  list.add_option("KIND", typed_.key,
                  "List this kind only: scenarios, studies, calibrations, tires, soils or vehicles (default: all).");
  list.add_flag("--json", typed_.json, "Print JSON.");

  CLI::App& starter =
      add("new", "Write a scenario of your own to start from, with a comment for every key, and print its name.",
          [this] { return new_command(new_); });
  starter.add_option("NAME", new_.name, "Write to this file; .json is added where it is missing.")->required();
  CLI::Option* tire = starter.add_option("--tire", new_.tire, "Use this tire file (default: the layered HMMWV tire).");
  starter.add_option("--soil", new_.soil,
                     "Use this soil file; one of empirical soil gives engine scm (default: cohesive grains).");
  starter.add_flag("--rigid", new_.rigid, "Make the tires rigid (tire.rigid).");
  CLI::Option* load =
      starter.add_option("--load", new_.load, "Set the load on the wheel, N (default: by the tire's size).")
          ->check(above_zero());
  starter.add_option("--vehicle", new_.vehicle, "Use this vehicle file: a whole vehicle in place of one wheel.")
      ->excludes(tire)
      ->excludes(load);
}

void CommandLine::add_runs() {
  CLI::App& run = add("run", "Run a scenario and print the folder that holds the results.",
                      [this] { return run_command(typed_, argc_, argv_); });
  add_scenario(run, typed_);
  add_folder_options(run, typed_.out, typed_.overwrite, "<scenario>-NNN");
  run.add_flag("--profile", typed_.profile, "Write profile.json too: where the time of each step goes (Chrome trace).");
  run.add_flag("--no-plots", typed_.no_plots, "Make no plots; 'furrow report' makes them later.");
  run.add_option("--seeds", typed_.seeds,
                 "Run on this number of beds, 2 to 1000, with run.seed, run.seed + 1, …, and write means and "
                 "95 % intervals. "
                 "The same command continues interrupted ones.");
  run.add_option("--jobs", typed_.jobs,
                 "Run this number of beds at once, each with its share of the cores (default: 1). It needs --seeds.");

  CLI::App& resume = add("resume",
                         "Continue a run from its last checkpoint. The result is bit-identical to that of an "
                         "uninterrupted run.",
                         [this] { return resume_command(typed_, argc_, argv_); });
  resume.add_option("DIR", typed_.directory, "Continue the run in this folder.")->required();
  resume.add_option("--until", typed_.until, "Run until this simulated time, s (run.end).");
  add_settings(resume, typed_);
  resume.add_flag("--profile", typed_.profile, "Write profile.json too, of the steps from here on.");
  resume.add_flag("--no-plots", typed_.no_plots, "Make no plots; 'furrow report' makes them later.");
}

void CommandLine::add_questions() {
  CLI::App& validate = add("validate",
                           "Check a scenario and estimate what a run of it will need, check a vehicle and print "
                           "its state at rest, or check a calibration study and print what it fits.",
                           [this] { return validate_command(typed_); });
  add_scenario(validate, typed_);
  validate.get_option("SCENARIO")
      ->description(
          "Check this scenario, vehicle or calibration study (JSON), as given, in rigs/ or in vehicle/data/.");
  validate.add_flag("--json", typed_.json, "Print JSON.");

  CLI::App& ranks = add(
      "ranks", "List which MPI rank does what, and how to start the ranks by hand; or print a batch script.", [this] {
        return ranks_command(typed_, slurm_, {argv_, argv_ + argc_});
      });
  add_scenario(ranks, typed_);
  add_slurm_options(ranks, typed_.slurm, slurm_);

  add("explain", "Explain a key of a scenario or of a calibration study, or list all keys of a scenario.",
      [this] { return explain_command(typed_.key); })
      .add_option(
          "KEY", typed_.key,
          "Explain the key of this dotted path, for example terrain.cohesion, or calibrate for calibration studies "
          "(default: list all keys of a scenario).");

  add("schema", "Print the JSON schema of a kind of files, for editors.", [this] { return schema_command(typed_.key); })
      .add_option("KIND", typed_.key, "Print the schema of these files: scenario, tire, vehicle or driver.")
      ->required();
}

void CommandLine::add_virtual_tests() {
  add_scenario(add("bed", "Settle the bed of a scenario, keep it for later runs, and print its statistics as JSON.",
                   [this] { return bed_command(load(typed_)); }),
               typed_);

  CLI::App& soil = add("soil",
                       "Run virtual soil tests on a scenario's grains (plate sinkage, direct shear, "
                       "cone, angle of repose) and print the results as JSON.",
                       [this] { return soil_command(load(typed_), soil_); });
  add_scenario(soil, typed_);
  add_soil_options(soil, soil_);

  CLI::App& press =
      add("press",
          "Press the tire of a scenario on a plate, a cleat or a profile, statically, and print the folder of the "
          "results.",
          [this] { return press_command(load(typed_), press_); });
  add_scenario(press, typed_);
  add_press_options(press, press_);

  add_modes_options(add("modes",
                        "Compute the lowest natural frequencies of a tire on a rim at rest, by circumferential "
                        "order, and print the folder of the results.",
                        [this] { return modes_command(modes_); }),
                    modes_);
}

void CommandLine::add_vehicles() {
  CLI::App& kc = add("kc",
                     "Move the suspensions of a vehicle, tabulate camber, toe, roll centre, rates and more "
                     "against travel and "
                     "steering, and print the folder of the results.",
                     [this] {
                       kinematics_.plots = !typed_.no_plots;
                       return kinematics_command(kinematics_);
                     });
  kc.add_option("VEHICLE", kinematics_.vehicle, "Read this vehicle file (JSON), as given or in vehicle/data/.")
      ->required();
  CLI::Option* out = add_folder_options(kc, kinematics_.out, kinematics_.overwrite, "<vehicle>-kc-NNN");
  kc.add_option("--travel", kinematics_.travel,
                "Move the wheels up and down by this travel, m (default: a fifth of the smallest tire's radius).");
  kc.add_option("--points", kinematics_.points, "Compute this number of points of each motion.")->capture_default_str();
  kc.add_flag("--no-plots", typed_.no_plots, "Make no plots; 'furrow report' makes them later.");
  CLI::Option* csv = kc.add_flag("--csv", kinematics_.csv, "Print the table as CSV and make no folder.")->excludes(out);
  kc.add_flag("--json", kinematics_.json, "Print table and figures as JSON and make no folder.")
      ->excludes(out)
      ->excludes(csv);
}

void CommandLine::add_studies() {
  CLI::App& sweep =
      add("sweep", "Run a parameter study, or continue an interrupted one.", [this] { return sweep_command(sweep_); });
  sweep.add_option("STUDY", sweep_.study, "Read this study file (JSON), as given or in rigs/.")->required();
  sweep.add_option("--out", sweep_.out, "Keep the study in this folder (default: results/<study>).");
  sweep.add_option("--jobs", sweep_.jobs, "Run this number of runs at once, each with its share of the cores.")
      ->capture_default_str();

  CLI::App& calibrate = add("calibrate",
                            "Fit the parameters of a tire or a soil to data, with the error of each, or continue an "
                            "interrupted calibration.",
                            [this] {
                              calibrate_.plots = !typed_.no_plots;
                              return calibrate_command(calibrate_);
                            });
  calibrate.add_option("STUDY", calibrate_.study, "Read this calibration study (JSON), as given or in rigs/.")
      ->required();
  calibrate.add_option("--out", calibrate_.out, "Keep the calibration in this folder (default: results/<study>).");
  calibrate.add_flag("--overwrite", calibrate_.overwrite,
                     "Begin again: remove what an earlier calibration wrote into the folder.");
  calibrate.add_flag("--no-plots", typed_.no_plots, "Make no plots; 'furrow report' makes them later.");

  CLI::App& report = add("report",
                         "Plot results of any command: PNG files and report.html, a page with plots and, of "
                         "a run, 3-D playback.",
                         [this] {
                           return report_command({.run = typed_.directory,
                                                  .others = typed_.others,
                                                  .out = typed_.out,
                                                  .soil = typed_.soil,
                                                  .vtk = typed_.vtk});
                         });
  report
      .add_option("DIR", typed_.directory,
                  "Read the results in this folder: of a run, of its beds, of a study, of a calibration or of tests.")
      ->required();
  report.add_option("OTHERS", typed_.others, "Compare the run of DIR with the runs in these folders, on one page.");
  report.add_option("--out", typed_.out,
                    "Write the files to this folder (default: DIR). It is required with several runs.");
  report.add_option("--soil", typed_.soil,
                    "Read this soil.json of 'furrow soil', and add what soil theory expects to the run's result.");
  report.add_option(
      "--vtk", typed_.vtk,
      "Write the frames of the run, tires and grains, as VTP files for ParaView and VTK to this new folder.");

  CLI::App& events = add("events", "List what happened in a vehicle's run and when, and compare its axles.", [this] {
    events_.directory = typed_.directory;
    return events_command(events_);
  });
  events.add_option("DIR", typed_.directory, "Read the run in this folder.")->required();
  events.add_option("--from", events_.from, "Begin the means at this time, s (default: where they are steady).");
  events.add_option("--to", events_.to, "End the means at this time, s (default: the end of the run).");
  events.add_flag("--json", events_.json, "Print JSON.");
}

void CommandLine::add_benches() {
  CLI::App& bench = *app_.add_subcommand("bench", "Measure how fast this machine is, and print JSON.");
  bench.footer(closing_words("bench"));
  bench.require_subcommand(1);
  add_grain_bench(add(bench, "grains", "Time the steps of a settled bed, with every grain integrated in every step.",
                      [this] { return bench_command(bench_grains, grains_); }),
                  grains_);
  add_tire_bench(add(bench, "tire", "Time the parts of a step of a loaded tire that rolls on hard ground.",
                     [this] { return bench_command(bench_tire, tire_); }),
                 tire_);
}

}  // namespace furrow::commands
