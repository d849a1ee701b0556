// Makes the plots of a run and its page, or a page that compares several runs, with scripts/python/furrow/report.py.
#include <sys/wait.h>

#include <chrono>
#include <cstring>
#include <iostream>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "nodes/commands/command_table.hpp"
#include "nodes/commands/python_script.hpp"
#include "nodes/launch/messages.hpp"
#include "nodes/launch/progress.hpp"
#include "nodes/launch/run_directory.hpp"
#include "nodes/launch/signals.hpp"
#include "nodes/scenario/rank_table.hpp"
#include "protocol/files/json_text.hpp"
#include "terrain/soil/soil_estimate.hpp"

namespace furrow::commands {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kPatience{60};  // for plots that were not asked for
constexpr std::chrono::seconds kShort{5};      // progress is shown if it takes longer, or if asked for

/// Shows the progress of the script. `display` outlives it.
void show_progress(PythonScript& script, launch::ProgressDisplay& display, const std::string& phase, bool unasked) {
  const Clock::time_point shown_from = Clock::now() + (unasked ? kShort : std::chrono::seconds{0});
  script.progress = [&display, phase, shown_from](double share) {
    if (Clock::now() >= shown_from) display.show({.phase = phase, .share = share});
  };
  script.message = [&display](const std::string& line) { display.say_error(line); };
}

struct ReportArguments {
  std::vector<std::filesystem::path> runs;  // one: its plots and page; several: a comparing page
  std::filesystem::path out = {};           // folder for the files; empty: the run's folder
  bool unasked = false;                     // made by another command: no messages, at most a minute
};

struct ReportRequest {
  std::string run;                  // folder
  std::vector<std::string> others;  // folders of runs, on one page with it
  std::filesystem::path out;        // empty: the run's folder
  std::string soil, vtk;            // soil.json for the theory; folder for VTP files; empty: none
};

/// Makes plots and page of a run, or the page of several. @returns none if the script reported an error. @throws Error
std::vector<std::filesystem::path> make_report(const ReportArguments& report) {
  for (const auto& run : report.runs) {
    launch::require_run_directory(run);
    launch::require_plain_files(run);
  }
  const std::filesystem::path& run = report.runs.front();
  if (std::filesystem::exists(report.out) && !is_directory(report.out))
    throw input_error(report.out.string(), "", "is a file, expected a folder");
  PythonScript script{.name = "report",
                      .folders = report.runs,
                      .what = "plots",
                      .quiet = report.unasked,
                      .deadline = report.unasked ? std::optional(Clock::now() + kPatience) : std::nullopt};
  if (!report.out.empty()) script.arguments = {"--out", report.out.string()};
  if (launch::messages_are_silenced()) script.arguments.emplace_back("--quiet");
  launch::ProgressDisplay display;
  show_progress(script, display, "plotting", report.unasked);
  const Finished finished = run_python(script);
  display.clear();
  const auto list = nlohmann::json::parse(finished.output, nullptr, false);
  if (launch::stop_signalled() && !report.unasked)
    throw Error(ExitCode::stopped, run.string() + ": the plots were stopped by a signal");
  if (WIFSIGNALED(finished.status) && !finished.too_late && !report.unasked)
    throw io_error(run.string(), fmt::format("the plots were ended by signal {} ({})", WTERMSIG(finished.status),
                                             strsignal(WTERMSIG(finished.status))));
  if (finished.too_late)
    throw io_error(run.string(), fmt::format("the plots took more than {} s; 'furrow report {}' waits for them",
                                             kPatience.count(), scenario::shell_path(run.string())));
  const int code = WIFEXITED(finished.status) ? WEXITSTATUS(finished.status) : -1;
  if (code == static_cast<int>(ExitCode::io) && !report.unasked) return {};
  if (code != 0 || !list.is_array())
    throw io_error(run.string(), launch::stop_signalled() ? "the plots were interrupted"
                                 : report.unasked         ? fmt::format("made no plots; 'furrow report {}' says why",
                                                                        scenario::shell_path(run.string()))
                                                          : "made no plots, expected the results of a run");
  std::vector<std::filesystem::path> plots;
  for (const auto& name : list) plots.push_back((report.out.empty() ? run : report.out) / name.get<std::string>());
  return plots;
}

/// Writes the frames of a run as VTP files into a new folder, and prints the names of the lists of these files.
/// @returns its exit code; the script has reported any error. @throws Error
ExitCode write_vtk(const std::filesystem::path& run, const std::filesystem::path& folder) {
  PythonScript script{
      .name = "frames_vtk", .arguments = {"--out", folder.string()}, .folders = {run}, .what = "VTP files"};
  launch::ProgressDisplay display;
  show_progress(script, display, "writing the frames", false);
  const Finished finished = run_python(script);
  display.clear();
  std::cout << finished.output << std::flush;
  const int code = WIFEXITED(finished.status) ? WEXITSTATUS(finished.status) : -1;
  for (const ExitCode said : {ExitCode::done, ExitCode::bad_input, ExitCode::io})
    if (code == static_cast<int>(said)) return said;
  if (launch::stop_signalled())
    throw Error(ExitCode::stopped, run.string() + ": writing VTP files was stopped by a signal");
  throw io_error(run.string(), "made no VTP files, expected the frames of a run");
}

ExitCode report(const ReportRequest& asked) {
  launch::require_run_directory(asked.run);
  launch::require_plain_files(asked.run);
  launch::catch_stop_signals();
  ReportArguments arguments{.runs = {asked.run}, .out = asked.out};
  arguments.runs.insert(arguments.runs.end(), asked.others.begin(), asked.others.end());
  if (!asked.others.empty() && asked.out.empty())
    throw input_error("command line", "--out",
                      "is missing, expected the folder of the page that compares several runs");
  if (!asked.others.empty() && !asked.soil.empty())
    throw input_error("command line", "--soil", "is given with several runs, expected one");
  if (!asked.others.empty() && !asked.vtk.empty())
    throw input_error("command line", "--vtk", "is given with several runs, expected one");
  if (!asked.soil.empty()) {
    const auto earlier = read_json_if_whole(asked.run + "/soil_estimate.json");
    if (launch::has_run_list(asked.run))
      launch::add_to_run_list(asked.run, {"soil_estimate.json"});
    else if (!earlier.contains("soil_file"))
      launch::require_own(asked.run, {"soil_estimate.json"});
    const std::string theory = terrain::soil::write_soil_estimate(asked.run, asked.soil);
    launch::say("furrow: " + theory + "\n");
  }
  if (!asked.vtk.empty()) {  // done first: a refused folder must not wait for the plots
    launch::say("furrow: writing the frames to " + asked.vtk + "\n");
    if (const ExitCode code = write_vtk(asked.run, asked.vtk); code != ExitCode::done) return code;
  }
  launch::say("furrow: plotting " + asked.run + "\n");
  const auto plots = make_report(arguments);
  for (const auto& plot : plots) std::cout << plot.string() << "\n";
  return plots.empty() ? ExitCode::io : ExitCode::done;
}

Action report_options(CLI::App& command, Typed&) {
  const auto asked = std::make_shared<ReportRequest>();
  command
      .add_option("DIR", asked->run,
                  "Read the results in this folder: of a run, of its beds, of a study, of a calibration or of tests.")
      ->required();
  command.add_option("OTHERS", asked->others, "Compare the run of DIR with the runs in these folders, on one page.");
  command.add_option("--out", asked->out,
                     "Write the files to this folder (default: DIR). It is required with several runs.");
  command.add_option("--soil", asked->soil,
                     "Read this soil.json of 'furrow soil', and add what soil theory expects to the run's result.");
  command.add_option(
      "--vtk", asked->vtk,
      "Write the frames of the run, tires and grains, as VTP files for ParaView and VTK to this new folder.");
  return [asked] { return report(*asked); };
}

}  // namespace

std::vector<std::filesystem::path> make_report_or_warn(const std::filesystem::path& run) {
  try {
    return make_report({.runs = {run}, .unasked = true});
  } catch (const Error& error) {
    print_warning(std::string("no plots: ") + error.what());
    return {};
  }
}

Command report_entry() {
  return {.name = "report",
          .task = task::compare,
          .purpose =
              "Plot results of any command: PNG files and report.html, a page with plots and, of a run, 3-D playback.",
          .options = report_options,
          .examples = {{"report results/first_look-001", "Make plots and report.html of a run."},
                       {"report results/a results/b --out both", "Compare runs on one page."}}};
}

}  // namespace furrow::commands
