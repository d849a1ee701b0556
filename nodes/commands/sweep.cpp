// `furrow sweep`: runs the table of a study.
#include <cstdio>
#include <iostream>
#include <memory>

#include "nodes/commands/command_table.hpp"
#include "nodes/launch/run_directory.hpp"
#include "nodes/launch/signals.hpp"
#include "nodes/study/beds.hpp"
#include "nodes/study/sweep.hpp"

namespace furrow::commands {
namespace {

struct SweepArguments {
  std::filesystem::path study;
  std::filesystem::path out;  // empty: results/<study>
  int jobs = 1;
  bool plots = true;
};

ExitCode sweep_study(const SweepArguments& arguments) {
  study::Study study = study::load_study(arguments.study);
  if (arguments.jobs < 1 || arguments.jobs > 1024)
    throw input_error("command line", "--jobs", "is " + std::to_string(arguments.jobs) + ", expected 1 to 1024");
  const std::filesystem::path folder =
      arguments.out.empty() ? std::filesystem::path("results") / study.name : arguments.out;
  const bool to_plot = arguments.plots && (study.passes > 0 || !study.plot.is_null());
  study::Sweep sweep(std::move(study), {folder, arguments.jobs});
  launch::RunDirectory directory = launch::RunDirectory::of_study(folder);
  study::require_no_beds(folder);
  sweep.require_places();
  if (const std::size_t others = sweep.runs_of_another_study(); others > 0)
    print_warning(
        "{}: held {} run{} of another study, or of this one before it was changed, and is replaced; they "
        "stay in {}, and that study's sweep makes its table again",
        (folder / "sweep.csv").string(), others, others > 1 ? "s" : "", (folder / "runs").string());
  launch::remove_unfinished(folder);
  launch::catch_stop_signals();
  const ExitCode code = sweep.run(directory.lock());
  if (code != ExitCode::stopped) {
    if (to_plot) make_report_or_warn(folder);
  } else {
    std::fprintf(stderr, "furrow: stopped by a signal; run the same command to continue\n");
  }
  if (code != ExitCode::done && code != ExitCode::stopped)
    print_error((folder / "sweep.csv").string() + ": not every run finished; the first that failed has exit code " +
                std::to_string(static_cast<int>(code)));
  std::cout << folder.string() << "\n";
  return code;
}

Action sweep_options(CLI::App& command, Typed&) {
  const auto arguments = std::make_shared<SweepArguments>();
  command.add_option("STUDY", arguments->study, "Read this study file (JSON), as given or in rigs/.")->required();
  command.add_option("--out", arguments->out, "Keep the study in this folder (default: results/<study>).");
  command.add_option("--jobs", arguments->jobs, "Run this number of runs at once, each with its share of the cores.")
      ->capture_default_str();
  add_no_plots(command, arguments->plots);
  return [arguments] { return sweep_study(*arguments); };
}

}  // namespace

Command sweep_entry() {
  return {.name = "sweep",
          .task = task::compare,
          .purpose = "Run a parameter study, or continue an interrupted one.",
          .options = sweep_options,
          .examples = {{"sweep study_slip.json --jobs 2", "Get pull against slip, two runs at once."}}};
}

}  // namespace furrow::commands
