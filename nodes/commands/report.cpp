// The plots of a run, made by scripts/report.py.
#include <sys/wait.h>

#include <chrono>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "nodes/commands/commands.hpp"
#include "nodes/commands/python_script.hpp"
#include "nodes/launch/run_directory.hpp"
#include "nodes/launch/signals.hpp"
#include "nodes/scenario/rank_table.hpp"

namespace furrow::commands {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kAddressSpace =
    512e6;  // bytes; a plot takes 300 MB, and numpy's BLAS waits forever for less
constexpr std::chrono::seconds kPatience{60};  // for plots that nobody asked for

}  // namespace

std::vector<std::filesystem::path> make_report(const std::filesystem::path& run, bool quiet) {
  launch::require_run_directory(run);
  const Finished finished =
      run_python({.name = "report.py",
                  .arguments = {},
                  .folder = run,
                  .what = "plots",
                  .address_space = kAddressSpace,
                  .quiet = quiet,
                  .deadline = quiet ? std::optional(Clock::now() + kPatience) : std::nullopt});
  const auto list = nlohmann::json::parse(finished.output, nullptr, false);
  if (finished.too_late)
    throw io_error(run.string(),
                   fmt::format("the plots took more than {} s; 'furrow report {}' waits for them",
                               kPatience.count(), scenario::shell_path(run.string())));
  if (!WIFEXITED(finished.status) || WEXITSTATUS(finished.status) != 0 || !list.is_array())
    throw io_error(run.string(), launch::stop_signalled() ? "the plots were interrupted"
                                 : quiet ? fmt::format("made no plots; 'furrow report {}' says why",
                                                       scenario::shell_path(run.string()))
                                         : "made no plots, expected the results of a run");
  std::vector<std::filesystem::path> plots;
  for (const auto& name : list) plots.push_back(run / name.get<std::string>());
  return plots;
}

std::vector<std::filesystem::path> make_report_or_warn(const std::filesystem::path& run) {
  try {
    return make_report(run, true);
  } catch (const Error& error) {
    print_warning(std::string("no plots: ") + error.what());
    return {};
  }
}

}  // namespace furrow::commands
