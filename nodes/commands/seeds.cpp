// `furrow run --seeds N`: a scenario on several beds, one after another or several at once, and the means over them.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "nodes/checkpoint/run_summary.hpp"
#include "nodes/commands/commands.hpp"
#include "nodes/launch/messages.hpp"
#include "nodes/launch/run_directory.hpp"
#include "nodes/launch/signals.hpp"
#include "nodes/scenario/load_scenario.hpp"
#include "nodes/scenario/rank_table.hpp"
#include "nodes/study/beds.hpp"
#include "protocol/files/digits.hpp"

namespace furrow::commands {
namespace {

using Json = nlohmann::ordered_json;
using checkpoint::number_at, checkpoint::value_at;

constexpr int kMostBeds = 1000;

void require_options(const RunArguments& arguments) {
  require_option(*arguments.seeds >= 2 && *arguments.seeds <= kMostBeds, "--seeds",
                 fmt::format("is {}, expected 2 to {} beds", *arguments.seeds, kMostBeds));
  require_option(arguments.jobs.value_or(1) >= 1 && arguments.jobs.value_or(1) <= 1024, "--jobs",
                 fmt::format("is {}, expected 1 to 1024", arguments.jobs.value_or(1)));
  require_option(!arguments.profile, "--profile", "is given with --seeds, expected it for a run on one bed");
}

/// "sinkage 21.0 ± 0.6 mm", empty if it was not measured.
std::string figure_text(const Json& wheel, const char* words, const char* figure, double scale, const char* unit) {
  const double mean = number_at(wheel, std::string(figure) + ".mean");
  if (!std::isfinite(mean)) return "";
  const double half = number_at(wheel, std::string(figure) + ".half_width_95");
  return fmt::format("{} {} {}", words, with_error(scale * mean, scale * half), unit);
}

std::string wheel_text(const Json& wheel, int beds, const scenario::Scenario& scenario) {
  if (number_at(wheel, "drawbar_pull_N.mean") == 0.0 && number_at(wheel, "drawbar_pull_N.sd") == 0.0)
    return fmt::format(
        "furrow: {} beds: the tire did not touch the terrain in the averaging window: nothing was measured\n", beds);
  std::vector<std::string> parts;
  for (const std::string& part :
       {figure_text(wheel, "drawbar pull", "drawbar_pull_N", 1.0, "N"),
        figure_text(wheel, "sinkage", "sinkage_m", 1e3, "mm"), figure_text(wheel, "rut", "rut_depth_m", 1e3, "mm")})
    if (!part.empty()) parts.push_back(part);
  std::string text =
      fmt::format("furrow: {} beds: {} (mean over beds and 95 % interval)\n", beds, fmt::join(parts, ", "));
  if (const double sd = number_at(wheel, "drawbar_pull_N.sd"); std::isfinite(sd))
    text += fmt::format("furrow: from bed to bed the pull varies by {} N (standard deviation)\n", digits(sd));
  text += expected_text(scenario.expected, beds, number_at(wheel, "drawbar_pull_N.mean"),
                        number_at(wheel, "sinkage_m.mean"), number_at(wheel, "rut_depth_m.mean"));
  return text;
}

std::string joined(const Json& names) {
  return fmt::format("{}", fmt::join(names.get<std::vector<std::string>>(), ", "));
}

std::string beds_text(const Json& summary, const scenario::Scenario& scenario) {
  std::string text;
  const Json failed = value_at(summary, "failed.beds"), unsteady = value_at(summary, "not_steady");
  const Json wheels = value_at(summary, "wheels");
  const auto beds = static_cast<int>(number_at(summary, "seeds")) - static_cast<int>(failed.size());
  if (beds < 2) return text;
  for (std::size_t k = 0; k < wheels.size(); ++k) {
    if (wheels.size() > 1) text += fmt::format("furrow: wheel {}\n", k);
    text += wheel_text(wheels[k], beds, scenario);
  }
  if (!unsteady.empty())
    text += fmt::format("furrow: NOT STEADY on {}; the means are over these beds too (see not_steady and runs in {})\n",
                        joined(unsteady), failed.empty() ? "summary.json" : "summary_failed.json");
  if (const Json large = value_at(summary, "step_too_large"); !large.empty())
    text += fmt::format("furrow: THE STEP IS TOO LARGE on {}: late forces have part in the means (see interface)\n",
                        joined(large));
  if (!failed.empty())
    text += fmt::format("furrow: {} failed; the means are over the other {} beds\n", joined(failed), beds);
  return text;
}

ExitCode run_beds_in(launch::RunDirectory& directory, const scenario::Scenario& scenario,
                     const RunArguments& arguments) {
  const std::filesystem::path& folder = directory.path();
  study::Sweep sweep(
      study::study_of_beds(arguments.scenario, scenario.name, arguments.settings, scenario.run.seed, *arguments.seeds),
      {folder, arguments.jobs.value_or(1)});
  sweep.require_places();
  study::begin_beds(directory, scenario.digest, arguments.overwrite);
  launch::remove_unfinished(folder);
  launch::catch_stop_signals();
  launch::say("furrow: {} on {} beds, results in {}\n", scenario.name, *arguments.seeds, folder.string());
  const ExitCode code = sweep.run(directory.lock());
  if (code != ExitCode::done && directory.replaces()) {
    const std::vector<study::Sweep::Outcome> outcomes = sweep.outcomes();
    const auto failed =
        std::find_if(outcomes.begin(), outcomes.end(), [](const auto& bed) { return !bed.problem.empty(); });
    directory.discard();
    if (failed != outcomes.end()) print_error(failed->folder.string() + ": " + failed->problem);
    std::fprintf(stderr, "furrow: no bed had begun to step; %s holds the earlier results again\n", folder.c_str());
    return code;
  }
  if (code == ExitCode::stopped) {
    std::fprintf(stderr, "furrow: stopped by a signal; to continue, run the same command with --out %s\n",
                 scenario::shell_quoted(folder.string()).c_str());
    return code;
  }
  const Json summary = study::summary_of_beds(scenario, sweep.outcomes());
  study::write_summary_of_beds(folder, summary);
  launch::say(beds_text(summary, scenario));
  if (arguments.plots) make_report_or_warn(folder);
  if (code != ExitCode::done)
    print_error((folder / "summary_failed.json").string() +
                ": not every bed finished: " + value_at(summary, "failed.error").get<std::string>());
  return code;
}

}  // namespace

ExitCode run_on_beds(const RunArguments& arguments) {
  require_options(arguments);
  const scenario::Scenario scenario = scenario::load_scenario(arguments.scenario, arguments.settings);
  for (const std::string& warning : scenario.warnings) print_warning(warning);
  study::require_beds(scenario, *arguments.seeds);
  require_launch(scenario);
  launch::RunDirectory directory = arguments.out.empty() ? launch::RunDirectory(scenario.name, {}, false)
                                                         : launch::RunDirectory::of_study(arguments.out);
  const ExitCode code = run_beds_in(directory, scenario, arguments);
  std::cout << directory.path().string() << "\n";
  return code;
}

}  // namespace furrow::commands
