// `furrow calibrate`: fits a model to data.
#include <algorithm>
#include <cstdio>
#include <iostream>
#include <memory>

#include <fmt/format.h>

#include "nodes/calibrate/calibrate.hpp"
#include "nodes/calibrate/evaluations.hpp"
#include "nodes/calibrate/explain.hpp"
#include "nodes/commands/command_table.hpp"
#include "nodes/commands/wrapped.hpp"
#include "nodes/launch/messages.hpp"
#include "nodes/launch/progress.hpp"
#include "nodes/launch/run_directory.hpp"
#include "nodes/launch/signals.hpp"
#include "protocol/files/digits.hpp"

namespace furrow::commands {
namespace {

using Json = nlohmann::ordered_json;

std::string percent(const Json& share) { return share.is_number() ? digits(100.0 * share.get<double>()) + " %" : "-"; }

/// Lines for a single figure, as of a noisy model: the reached and the wanted value.
std::string figure_lines(const Json& target, const char* how) {
  std::string text;
  for (const Json& f : target["figures"]) {
    const Json& told = f.contains("surrogate") ? f["surrogate"] : f;
    if (!f.contains("evaluated")) continue;
    const double value = (f.contains("surrogate") ? told["value"] : f["evaluated"]).get<double>();
    const Json& error = told["standard_error"];
    text += fmt::format("furrow: {} {} {}, target {}{}\n", how, target["name"].get<std::string>(),
                        error.is_number() ? with_error(value, error.get<double>()) : digits(value),
                        with_error(f["target"].get<double>(), f["sigma"].get<double>()),
                        f.contains("state") ? ": " + f["state"].get<std::string>() : "");
  }
  return text;
}

/// Unit of a column such as force_N.
std::string unit_of(const std::string& column) { return column.substr(column.rfind('_') + 1); }

std::string target_line(const Json& target, const char* how) {
  if (target.contains("problem"))
    return fmt::format("furrow: {} {}: no answer\n", how, target["name"].get<std::string>());
  if (target.contains("figures") && target["points"] == 1) return figure_lines(target, how);
  const Json& r = target["r_squared"];
  return fmt::format("furrow: {} {} ({}): R² {}, largest error {:.3g} {}, {} of the peak\n", how,
                     target["name"].get<std::string>(), target["what"].get<std::string>(),
                     r.is_number() ? fmt::format("{:.4f}", r.get<double>()) : "-",
                     target["largest_error"].get<double>(), unit_of(target["y"].get<std::string>()),
                     percent(target["largest_error_of_peak"]));
}

std::string calibration_text(const Json& summary) {
  std::string text;
  for (const auto& [name, p] : summary["parameters"].items()) {
    const double value = p["value"].get<double>();
    const Json& error = p["standard_error"];
    const std::string unit = p["unit"].get<std::string>();
    text += fmt::format("furrow: {} {}{}{}\n", name,
                        error.is_number() ? with_error(value, error.get<double>()) : digits(value),
                        unit == "-" ? "" : " " + unit,
                        p["at_bound"].is_string() ? fmt::format(", its {} bound", p["at_bound"].get<std::string>())
                        : error.is_number()       ? ""
                                                  : ", not determined");
  }
  for (const Json& target : summary["targets"]) text += target_line(target, "fitted");
  for (const Json& target : summary["held_out_targets"]) text += target_line(target, "predicted");
  if (summary.contains("processor_s"))
    text +=
        fmt::format("furrow: {} evaluations, {:.2g} minutes of processor time: {}\n", summary["evaluations"].get<int>(),
                    summary["processor_s"].get<double>() / 60.0, summary["ended"].get<std::string>());
  return text;
}

struct CalibrateArguments {
  std::filesystem::path study;
  std::filesystem::path out;  // empty: results/<study>
  bool overwrite = false;
  bool plots = true;
};

ExitCode calibrate_study(const CalibrateArguments& arguments) {
  const calibrate::Calibration calibration = calibrate::load_calibration(arguments.study);
  const std::filesystem::path folder =
      arguments.out.empty() ? std::filesystem::path("results") / calibration.name : arguments.out;
  std::vector<std::string> files{calibrate::kCalibration, calibrate::kEvaluations, "fit.csv", calibration.result};
  for (const calibrate::ResultFile& further : calibration.model->further_files(calibration.model->start_values(), ""))
    files.push_back(further.name);
  launch::RunDirectory directory = launch::RunDirectory::of_calibration(folder, arguments.overwrite, files);
  launch::remove_unfinished(folder);
  launch::catch_stop_signals();
  directory.add(files);
  launch::say("furrow: calibration {}, results in {}\n", calibration.name, folder.string());
  const std::vector<std::string> notes = calibration.model->notes();
  for (const std::string& note : notes) print_warning(note);
  try {
    launch::ProgressDisplay display;
    const calibrate::CalibrationResults results =
        calibrate::calibrate(calibration, folder, [&](const std::string& what, double share) {
          if (launch::stop_signalled()) throw Error(ExitCode::stopped, "stopped by a signal");
          if (!directory.lock().stands())
            throw io_error(folder.string(),
                           "was moved, removed or emptied while the calibration was under way; it ends here");
          display.show({.phase = what, .share = share});
        });
    display.clear();
    calibrate::write_calibration(calibration, results, folder);
    const Json summary = calibrate::calibration_json(calibration, results);
    launch::say(calibration_text(summary));
    const auto warnings = summary["warnings"].get<std::vector<std::string>>();
    for (const std::string& warning : warnings)
      if (std::find(notes.begin(), notes.end(), warning) == notes.end()) print_warning(warning);
  } catch (const Error& error) {
    const bool replaces = directory.replaces();
    if (replaces) {
      directory.discard();
      std::fprintf(stderr, "furrow: nothing had been evaluated; %s holds the earlier results again\n", folder.c_str());
    }
    if (error.code() != ExitCode::stopped) throw;
    std::fprintf(stderr, "furrow: stopped by a signal; run the same command to %s\n",
                 replaces ? "begin again" : "continue");
    std::cout << folder.string() << "\n";
    return ExitCode::stopped;
  }
  std::cout << folder.string() << std::endl;
  if (arguments.plots) make_report_or_warn(folder);
  return ExitCode::done;
}

Action calibrate_options(CLI::App& command, Typed&) {
  const auto arguments = std::make_shared<CalibrateArguments>();
  command.add_option("STUDY", arguments->study, "Read this calibration study (JSON), as given or in rigs/.")
      ->required();
  command.add_option("--out", arguments->out, "Keep the calibration in this folder (default: results/<study>).");
  command.add_flag("--overwrite", arguments->overwrite,
                   "Begin again: remove what an earlier calibration wrote into the folder.");
  add_no_plots(command, arguments->plots);
  return [arguments] { return calibrate_study(*arguments); };
}

}  // namespace

ExitCode validate_calibration(const std::string& name, bool json) {
  const calibrate::Calibration calibration = calibrate::load_calibration(name);
  for (const std::string& note : calibration.model->notes()) print_warning(note);
  if (json)
    std::cout << calibrate::calibration_check_json(calibration).dump(2) << "\n";
  else
    print_text(calibrate::calibration_check_text(calibration), Piped::whole_lines);
  return ExitCode::done;
}

Command calibrate_entry() {
  return {.name = "calibrate",
          .task = task::compare,
          .purpose =
              "Fit the parameters of a tire or a soil to data, with the error of each, or continue an interrupted "
              "calibration.",
          .options = calibrate_options,
          .examples = {{"calibrate calibrate_ring.json", "Fit the ring to the shell, with errors."}}};
}

}  // namespace furrow::commands
