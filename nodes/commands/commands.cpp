#include "nodes/commands/commands.hpp"

#include <algorithm>
#include <cstdio>
#include <functional>
#include <iostream>
#include <new>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "nodes/commands/bench.hpp"
#include "nodes/commands/examples.hpp"
#include "nodes/commands/options.hpp"
#include "nodes/commands/questions.hpp"
#include "nodes/commands/wrapped.hpp"
#include "nodes/launch/messages.hpp"
#include "nodes/launch/progress.hpp"
#include "nodes/launch/run_directory.hpp"
#include "nodes/launch/signals.hpp"
#include "nodes/scenario/load_scenario.hpp"
#include "nodes/scenario/machine_speed.hpp"
#include "nodes/scenario/memory_check.hpp"
#include "nodes/scenario/rank_table.hpp"
#include "nodes/scenario/run_time.hpp"
#include "nodes/scenario/runnable.hpp"
#include "nodes/scenario/validate.hpp"
#include "nodes/scenario/vehicle_tires.hpp"
#include "nodes/study/calibrate_study.hpp"
#include "protocol/files/nearest_words.hpp"
#include "protocol/files/printable.hpp"
#include "protocol/mpi_transport.hpp"
#include "terrain/soil/soil_estimate.hpp"

namespace furrow::commands {
namespace {

/// What the user typed, as CLI11 fills it in.
struct Typed {
  std::string scenario, threads, key, directory, soil, until, vtk;
  std::filesystem::path out;
  std::vector<std::string> settings, others;
  bool overwrite = false, profile = false, json = false, no_plots = false, slurm = false;
  std::optional<int> seeds, jobs;
  double memory = 0.0;  // that the scenario needs, bytes; 0: not known yet
};

constexpr std::size_t kMaxShown = 400;  // bytes of what the command line has wrong

Error usage_error(const std::string& what) { return input_error("command line", "", what); }

void add_settings(CLI::App& command, Typed& typed) {
  command
      .add_option("--set", typed.settings,
                  "Set a scenario key by its dotted path, as key=value. The option may be repeated.")
      ->take_all()
      ->allow_extra_args(false);
  command.add_option("--threads", typed.threads,
                     "Compute the terrain with this number of threads, or with 'auto' (run.threads).");
}

void add_scenario(CLI::App& command, Typed& typed) {
  command.add_option("SCENARIO", typed.scenario, "Read this scenario file (JSON), as given or in rigs/.")->required();
  add_settings(command, typed);
}

Settings settings_of(const Typed& typed) {
  Settings settings;
  for (const std::string& text : typed.settings) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0)
      throw input_error("command line", "--set", "is '" + excerpt(text) + "', expected the form key=value");
    settings.emplace_back(text.substr(0, equals), text.substr(equals + 1));
  }
  if (!typed.threads.empty()) settings.emplace_back("run.threads", typed.threads);
  if (!typed.until.empty()) settings.emplace_back("run.end", typed.until);
  return settings;
}

scenario::Scenario load(Typed& typed) {
  scenario::Scenario scenario = scenario::load_scenario(typed.scenario, settings_of(typed));
  typed.memory = scenario.memory.all;
  for (const std::string& warning : scenario.warnings) print_warning(warning);
  return scenario;
}

ExitCode validate_command(Typed& typed) {
  const bool vehicle = scenario::is_vehicle(typed.scenario),
             calibration = !vehicle && study::is_calibration(typed.scenario);
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

ExitCode ranks_command(Typed& typed, const SlurmArguments& slurm,
                       const std::vector<std::string>& command_line) {
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

ExitCode report_command(const Typed& typed) {
  launch::require_run_directory(typed.directory);
  ReportArguments report{.runs = {typed.directory}, .out = typed.out};
  report.runs.insert(report.runs.end(), typed.others.begin(), typed.others.end());
  if (!typed.others.empty() && typed.out.empty())
    throw input_error("command line", "--out",
                      "is missing, expected the folder of the page that compares several runs");
  if (!typed.others.empty() && !typed.soil.empty())
    throw input_error("command line", "--soil", "is given with several runs, expected one");
  if (!typed.others.empty() && !typed.vtk.empty())
    throw input_error("command line", "--vtk", "is given with several runs, expected one");
  if (!typed.soil.empty()) {
    if (launch::has_run_list(typed.directory))
      launch::add_to_run_list(typed.directory, {"soil_estimate.json"});
    const std::string theory = terrain::soil::write_soil_estimate(typed.directory, typed.soil);
    launch::say("furrow: " + theory + "\n");
  }
  if (!typed.vtk.empty()) {  // first: a folder that is refused must not wait for the plots
    launch::say("furrow: writing the frames to " + typed.vtk + "\n");
    if (const ExitCode code = write_vtk(typed.directory, typed.vtk); code != ExitCode::done) return code;
  }
  launch::say("furrow: plotting " + typed.directory + "\n");
  const auto plots = make_report(report);
  for (const auto& plot : plots) std::cout << plot.string() << "\n";
  return plots.empty() ? ExitCode::io : ExitCode::done;
}

ExitCode run_command(const Typed& typed, int argc, char** argv) {
  const RunArguments arguments{typed.scenario,  settings_of(typed),      typed.out,
                               typed.overwrite, typed.profile,           !typed.no_plots,
                               false,           typed.seeds.value_or(0), typed.jobs.value_or(1)};
  if (typed.seeds) return run_on_beds(arguments);
  if (typed.jobs)
    throw input_error("command line", "--jobs",
                      "is given without --seeds, expected both: one bed is one job");
  return launched_by_mpi() ? run_as_rank(arguments, argc, argv) : run_supervised(arguments);
}

ExitCode resume_command(const Typed& typed, int argc, char** argv) {
  RunArguments arguments{{},  settings_of(typed), typed.directory, false, typed.profile, !typed.no_plots,
                         true};
  return launched_by_mpi() ? run_as_rank(arguments, argc, argv) : resume_supervised(arguments);
}

template <class Bench>
ExitCode bench_command(std::string (*run)(const Bench&, const ProgressCall&), const Bench& bench) {
  if (const int cores = static_cast<int>(allowed_cores().size()); bench.threads > cores)
    print_warning(
        fmt::format("--threads {}: this program may use {} cores, more threads than that wait for each other",
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

/// Commands that say more than their result, and those below them, take --quiet.
void add_quiet(CLI::App& app) {
  const auto all = [](const CLI::App*) { return true; };
  for (CLI::App* command : app.get_subcommands(all)) {
    const std::string name = command->get_name();
    if (!command->get_subcommands(all).empty())
      add_quiet(*command);
    else if (name != "list" && name != "explain" && name != "events")
      command->add_flag_callback(
          "--quiet", launch::silence_messages,
          "Print errors only on standard error; what goes to standard output stays the same.");
  }
}

/// The command whose help says more, with a blank after it.
std::string asked_command(const CLI::App& app) {
  for (const CLI::App* command : app.get_subcommands())
    return command->get_name() + " " + asked_command(*command);
  return {};
}

/// CLI11's words, with a guess at what was meant.
std::string parse_problem(const CLI::App& app, const CLI::ParseError& error, int argc, char** argv) {
  std::vector<std::string> commands;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    commands.push_back(command->get_name());
  const std::string first = argc > 1 ? argv[1] : "";
  if (first.empty())
    return fmt::format("no command is given, expected one of: {}; see furrow --help",
                       fmt::join(commands, ", "));
  if (first[0] != '-' && std::find(commands.begin(), commands.end(), first) == commands.end()) {
    const std::vector<std::string> similar = nearest_words(first, commands);
    return fmt::format("unknown command '{}'; {}", excerpt(first),
                       similar.empty()
                           ? fmt::format("expected one of: {}; see furrow --help", fmt::join(commands, ", "))
                           : "did you mean '" + similar.front() + "'?");
  }
  return fmt::format("{}, see furrow {}--help", excerpt(error.what(), kMaxShown), asked_command(app));
}

/// Names with control characters would make two messages of one. Values of keys may be of several lines.
void check_arguments(int argc, char** argv) {
  for (int k = 1; k < argc; ++k) {
    const std::string text = argv[k];
    if (std::string(argv[k - 1]) == "--set" || text.starts_with("--set=")) continue;
    if (std::any_of(text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7F; }))
      throw usage_error("the argument '" + excerpt(text) + "' holds a control character, expected none");
  }
}

void print_lines(const char* kind, const std::string& text) {
  std::size_t from = 0;
  for (std::size_t end; from <= text.size(); from = end + 1) {
    end = std::min(text.find('\n', from), text.size());
    std::fprintf(stderr, "furrow: %s: %s\n", kind, printable(text.substr(from, end - from)).c_str());
  }
}

/// The command line of `furrow`: what it understands, and what the user chose.
class CommandLine {
 public:
  CommandLine(int argc, char** argv) : argc_(argc), argv_(argv) {
    app_.set_help_flag("-h,--help", "Print this help and exit.");
    app_.set_version_flag("--version", "furrow " FURROW_VERSION, "Print the version and exit.");
    app_.require_subcommand(1);
    app_.footer(closing_words(""));
    add_group("Begin", &CommandLine::add_beginnings);
    add_group("Run", &CommandLine::add_runs);
    add_group("Ask before a run", &CommandLine::add_questions);
    add_group("Test tires, soils and vehicles", &CommandLine::add_virtual_tests);
    add_group("Test tires, soils and vehicles", &CommandLine::add_vehicles);
    add_group("Compare and look", &CommandLine::add_studies);
    add_group("Measure this machine", &CommandLine::add_benches);
    add_quiet(app_);
  }

  ExitCode execute() {
    check_arguments(argc_, argv_);
    try {
      app_.parse(argc_, argv_);
    } catch (const CLI::Success& asked) {  // --help, --version
      std::ostringstream text;
      app_.exit(asked, text);
      print_text(text.str(), Piped::wrap);
      return ExitCode::done;
    } catch (const CLI::ParseError& error) {
      throw usage_error(parse_problem(app_, error, argc_, argv_));
    }
    try {
      return chosen_();
    } catch (const std::bad_alloc&) {
      throw scenario::out_of_memory(typed_.memory);
    }
  }

 private:
  /// A command, and what is done when it is the one that was given.
  CLI::App& add(CLI::App& parent, const char* name, const char* purpose, std::function<ExitCode()> action) {
    CLI::App& command = *parent.add_subcommand(name, purpose);
    command.footer(closing_words(&parent == &app_ ? name : parent.get_name() + " " + name));
    command.callback([this, action = std::move(action)] { chosen_ = action; });
    return command;
  }
  CLI::App& add(const char* name, const char* purpose, std::function<ExitCode()> action) {
    return add(app_, name, purpose, std::move(action));
  }

  /// Commands that serve one task stand together in the help.
  void add_group(const char* task, void (CommandLine::*add_commands)()) {
    const auto all = [](const CLI::App*) { return true; };
    const std::size_t before = app_.get_subcommands(all).size();
    (this->*add_commands)();
    const std::vector<CLI::App*> commands = app_.get_subcommands([](CLI::App*) { return true; });
    for (std::size_t k = before; k < commands.size(); ++k) commands[k]->group(task);
  }
  void add_beginnings();
  void add_runs();
  void add_questions();
  void add_virtual_tests();
  void add_vehicles();
  void add_studies();
  void add_benches();

  int argc_;
  char** argv_;
  CLI::App app_{"Furrow: how much a flexible tire pulls on granular soil, and how deep it sinks.", "furrow"};
  std::function<ExitCode()> chosen_;
  Typed typed_;
  SoilArguments soil_;
  PressArguments press_;
  ModesArguments modes_;
  KinematicsArguments kinematics_;
  NewArguments new_;
  EventsArguments events_;
  SweepArguments sweep_;
  CalibrateArguments calibrate_;
  SlurmArguments slurm_;
  GrainBench grains_;
  TireBench tire_;
};

void CommandLine::add_beginnings() {
  CLI::App& list =
      add("list", "List the scenarios, studies, calibrations, tires, soils and vehicles that come with Furrow.",
          [this] { return list_command(typed_.key, typed_.json); });
  list.add_option("KIND", typed_.key,
                  "List this kind only: scenarios, studies, calibrations, tires, soils or vehicles (default: all).");
  list.add_flag("--json", typed_.json, "Print JSON.");

  CLI::App& starter = add(
      "new", "Write a scenario of your own to start from, with a comment for every key, and print its name.",
      [this] { return new_command(new_); });
  starter.add_option("NAME", new_.name, "Write to this file; .json is added where it is missing.")
      ->required();
  CLI::Option* tire =
      starter.add_option("--tire", new_.tire, "Use this tire file (default: the layered HMMWV tire).");
  starter.add_option(
      "--soil", new_.soil,
      "Use this soil file; one of empirical soil gives engine scm (default: cohesive grains).");
  starter.add_flag("--rigid", new_.rigid, "Make the tires rigid (tire.rigid).");
  CLI::Option* load =
      starter.add_option("--load", new_.load, "Set the load on the wheel, N (default: by the tire's size).")
          ->check(above_zero());
  starter
      .add_option("--vehicle", new_.vehicle, "Use this vehicle file: a whole vehicle in place of one wheel.")
      ->excludes(tire)
      ->excludes(load);
}

void CommandLine::add_runs() {
  CLI::App& run = add("run", "Run a scenario and print the folder that holds the results.",
                      [this] { return run_command(typed_, argc_, argv_); });
  add_scenario(run, typed_);
  add_folder_options(run, typed_.out, typed_.overwrite, "<scenario>-NNN");
  run.add_flag("--profile", typed_.profile,
               "Write profile.json too: where the time of each step goes (Chrome trace).");
  run.add_flag("--no-plots", typed_.no_plots, "Make no plots; 'furrow report' makes them later.");
  run.add_option("--seeds", typed_.seeds,
                 "Run on this number of beds, 2 to 1000, with run.seed, run.seed + 1, …, and write means and "
                 "95 % intervals. "
                 "The same command continues interrupted ones.");
  run.add_option(
      "--jobs", typed_.jobs,
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
  validate.get_option("SCENARIO")->description(
      "Check this scenario, vehicle or calibration study (JSON), as given, in rigs/ or in vehicle/data/.");
  validate.add_flag("--json", typed_.json, "Print JSON.");

  CLI::App& ranks = add(
      "ranks", "List which MPI rank does what, and how to start the ranks by hand; or print a batch script.",
      [this] {
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
}

void CommandLine::add_virtual_tests() {
  add_scenario(
      add("bed", "Settle the bed of a scenario, keep it for later runs, and print its statistics as JSON.",
          [this] { return bed_command(load(typed_)); }),
      typed_);

  CLI::App& soil = add("soil",
                       "Run virtual soil tests on a scenario's grains (plate sinkage, direct shear, "
                       "cone, angle of repose) and print the results as JSON.",
                       [this] { return soil_command(load(typed_), soil_); });
  add_scenario(soil, typed_);
  add_soil_options(soil, soil_);

  CLI::App& press = add(
      "press",
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
  kc.add_option("VEHICLE", kinematics_.vehicle,
                "Read this vehicle file (JSON), as given or in vehicle/data/.")
      ->required();
  CLI::Option* out = add_folder_options(kc, kinematics_.out, kinematics_.overwrite, "<vehicle>-kc-NNN");
  kc.add_option(
      "--travel", kinematics_.travel,
      "Move the wheels up and down by this travel, m (default: a fifth of the smallest tire's radius).");
  kc.add_option("--points", kinematics_.points, "Compute this number of points of each motion.")
      ->capture_default_str();
  kc.add_flag("--no-plots", typed_.no_plots, "Make no plots; 'furrow report' makes them later.");
  CLI::Option* csv =
      kc.add_flag("--csv", kinematics_.csv, "Print the table as CSV and make no folder.")->excludes(out);
  kc.add_flag("--json", kinematics_.json, "Print table and figures as JSON and make no folder.")
      ->excludes(out)
      ->excludes(csv);
}

void CommandLine::add_studies() {
  CLI::App& sweep = add("sweep", "Run a parameter study, or continue an interrupted one.",
                        [this] { return sweep_command(sweep_); });
  sweep.add_option("STUDY", sweep_.study, "Read this study file (JSON), as given or in rigs/.")->required();
  sweep.add_option("--out", sweep_.out, "Keep the study in this folder (default: results/<study>).");
  sweep
      .add_option("--jobs", sweep_.jobs, "Run this number of runs at once, each with its share of the cores.")
      ->capture_default_str();

  CLI::App& calibrate = add("calibrate",
                            "Fit the parameters of a tire or a soil to data, with the error of each, or continue an "
                            "interrupted calibration.",
                            [this] {
                              calibrate_.plots = !typed_.no_plots;
                              return calibrate_command(calibrate_);
                            });
  calibrate
      .add_option("STUDY", calibrate_.study, "Read this calibration study (JSON), as given or in rigs/.")
      ->required();
  calibrate.add_option("--out", calibrate_.out, "Keep the calibration in this folder (default: results/<study>).");
  calibrate.add_flag("--overwrite", calibrate_.overwrite,
                     "Begin again: remove what an earlier calibration wrote into the folder.");
  calibrate.add_flag("--no-plots", typed_.no_plots, "Make no plots; 'furrow report' makes them later.");

  CLI::App& report = add("report",
                         "Plot results of any command: PNG files and report.html, a page with plots and, of "
                         "a run, 3-D playback.",
                         [this] { return report_command(typed_); });
  report
      .add_option("DIR", typed_.directory,
                  "Read the results in this folder: of a run, of its beds, of a study, of a calibration or of tests.")
      ->required();
  report.add_option("OTHERS", typed_.others,
                    "Compare the run of DIR with the runs in these folders, on one page.");
  report.add_option("--out", typed_.out,
                    "Write the files to this folder (default: DIR). It is required with several runs.");
  report.add_option(
      "--soil", typed_.soil,
      "Read this soil.json of 'furrow soil', and add what soil theory expects to the run's result.");
  report.add_option(
      "--vtk", typed_.vtk,
      "Write the frames of the run, tires and grains, as VTP files for ParaView and VTK to this new folder.");

  CLI::App& events =
      add("events", "List what happened in a vehicle's run and when, and compare its axles.", [this] {
        events_.directory = typed_.directory;
        return events_command(events_);
      });
  events.add_option("DIR", typed_.directory, "Read the run in this folder.")->required();
  events.add_option("--from", events_.from,
                    "Begin the means at this time, s (default: where they are steady).");
  events.add_option("--to", events_.to, "End the means at this time, s (default: the end of the run).");
  events.add_flag("--json", events_.json, "Print JSON.");
}

void CommandLine::add_benches() {
  CLI::App& bench = *app_.add_subcommand("bench", "Measure how fast this machine is, and print JSON.");
  bench.footer(closing_words("bench"));
  bench.require_subcommand(1);
  add_grain_bench(
      add(bench, "grains", "Time the steps of a settled bed, with every grain integrated in every step.",
          [this] { return bench_command(bench_grains, grains_); }),
      grains_);
  add_tire_bench(add(bench, "tire", "Time the parts of a step of a loaded tire that rolls on hard ground.",
                     [this] { return bench_command(bench_tire, tire_); }),
                 tire_);
}

}  // namespace

void print_error(const std::string& text) { print_lines("error", text); }
void print_warning(const std::string& text) {
  if (!launch::messages_are_silenced()) print_lines("warning", text);
}

bool runs_as_rank(int argc, char** argv) {
  const std::string command = argc > 1 ? argv[1] : "";
  const bool starts_runs = std::any_of(argv, argv + argc, [](const char* text) {
    return std::string_view(text) == "--seeds" || std::string_view(text).starts_with("--seeds=");
  });
  return (command == "resume" || (command == "run" && !starts_runs)) && launched_by_mpi();
}

ExitCode run_command_line(int argc, char** argv) { return CommandLine(argc, argv).execute(); }

}  // namespace furrow::commands
