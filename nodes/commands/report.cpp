// The plots of a run and its page, or the page that compares several, made by scripts/report.py.
#include <sys/wait.h>

#include <chrono>
#include <cstring>
#include <iostream>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "nodes/commands/commands.hpp"
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

constexpr double kAddressSpace = 512e6;        // bytes; a plot takes 300 MB, and numpy's BLAS waits forever for less
constexpr std::chrono::seconds kPatience{60};  // for plots that nobody asked for
constexpr std::chrono::seconds kShort{5};      // what takes no longer needs no progress, unless it was asked for

/// Shows how far the script is. `display` outlives it.
void show_progress(PythonScript& script, launch::ProgressDisplay& display, const std::string& phase, bool unasked) {
  const Clock::time_point shown_from = Clock::now() + (unasked ? kShort : std::chrono::seconds{0});
  script.progress = [&display, phase, shown_from](double share) {
    if (Clock::now() >= shown_from) display.show({.phase = phase, .share = share});
  };
  script.message = [&display](const std::string& line) { display.say_error(line); };
}

}  // namespace

std::vector<std::filesystem::path> make_report(const ReportArguments& report) {
  for (const auto& run : report.runs) {
    launch::require_run_directory(run);
    launch::require_plain_files(run);
  }
  const std::filesystem::path& run = report.runs.front();
  if (std::filesystem::exists(report.out) && !is_directory(report.out))
    throw input_error(report.out.string(), "", "is a file, expected a folder");
  PythonScript script{.name = "report.py",
                      .arguments = {},
                      .folders = report.runs,
                      .what = "plots",
                      .address_space = kAddressSpace,
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

std::vector<std::filesystem::path> make_report_or_warn(const std::filesystem::path& run) {
  try {
    return make_report({.runs = {run}, .unasked = true});
  } catch (const Error& error) {
    print_warning(std::string("no plots: ") + error.what());
    return {};
  }
}

ExitCode write_vtk(const std::filesystem::path& run, const std::filesystem::path& folder) {
  PythonScript script{.name = "frames_vtk.py",
                      .arguments = {"--out", folder.string()},
                      .folders = {run},
                      .what = "VTP files",
                      .address_space = kAddressSpace,
                      .quiet = false,
                      .deadline = std::nullopt};
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

ExitCode report_command(const ReportRequest& asked) {
  launch::require_run_directory(asked.run);
  launch::require_plain_files(asked.run);
  launch::catch_stop_signals();
  ReportArguments report{.runs = {asked.run}, .out = asked.out};
  report.runs.insert(report.runs.end(), asked.others.begin(), asked.others.end());
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
  if (!asked.vtk.empty()) {  // first: a folder that is refused must not wait for the plots
    launch::say("furrow: writing the frames to " + asked.vtk + "\n");
    if (const ExitCode code = write_vtk(asked.run, asked.vtk); code != ExitCode::done) return code;
  }
  launch::say("furrow: plotting " + asked.run + "\n");
  const auto plots = make_report(report);
  for (const auto& plot : plots) std::cout << plot.string() << "\n";
  return plots.empty() ? ExitCode::io : ExitCode::done;
}

}  // namespace furrow::commands
