// The plots of a run and its page, or the page that compares several, made by scripts/report.py with Debian's own
// Python, whatever python stands first on PATH, and isolated (-I) from what the user's environment and folders have for
// Python.
#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>
#include <csignal>

#include <array>
#include <cerrno>
#include <chrono>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "nodes/commands/commands.hpp"
#include "nodes/launch/child_process.hpp"
#include "nodes/launch/run_directory.hpp"
#include "nodes/launch/signals.hpp"
#include "nodes/scenario/rank_table.hpp"
#include "protocol/files/data_files.hpp"
#include "protocol/memory_limit.hpp"

namespace furrow::commands {
namespace {

using Clock = std::chrono::steady_clock;

constexpr const char* kPython = "/usr/bin/python3";
constexpr double kAddressSpace =
    512e6;  // bytes; a plot takes 300 MB, and numpy's BLAS waits forever for less
constexpr std::chrono::seconds kPatience{60};  // for plots that nobody asked for

struct Finished {
  int status = 0;         // of waitpid
  std::string output;     // standard output
  bool too_late = false;  // it was ended at the deadline
};

/// Runs a program to its end; a stop signal or the deadline ends it.
Finished run_program(std::vector<std::string> command, bool quiet,
                     std::optional<Clock::time_point> deadline) {
  launch::Pipe pipe;
  const int nothing = open("/dev/null", O_WRONLY | O_CLOEXEC);
  const pid_t child = launch::start_child({.command = std::move(command),
                                           .out = pipe.write,
                                           .err = quiet ? nothing : -1,
                                           .death_signal = SIGKILL});
  close(nothing);
  pipe.close_write();
  Finished finished;
  std::array<char, 4096> bytes;
  for (;;) {
    pollfd readable{.fd = pipe.read, .events = POLLIN, .revents = 0};
    const int ready = poll(&readable, 1, deadline ? 500 : -1);  // ms
    if (launch::stop_signalled()) kill(child, SIGTERM);
    if (deadline && !finished.too_late && Clock::now() > *deadline) {
      finished.too_late = true;
      kill(child, SIGKILL);
    }
    if (ready <= 0) continue;
    const ssize_t count = read(pipe.read, bytes.data(), bytes.size());
    if (count > 0)
      finished.output.append(bytes.data(), static_cast<std::size_t>(count));
    else if (count == 0 || errno != EINTR)
      break;
  }
  pipe.close_read();
  while (waitpid(child, &finished.status, 0) < 0 && errno == EINTR)
    if (launch::stop_signalled()) kill(child, SIGTERM);
  return finished;
}

}  // namespace

std::vector<std::filesystem::path> make_report(const ReportArguments& report) {
  for (const auto& run : report.runs) launch::require_run_directory(run);
  const std::filesystem::path& run = report.runs.front();
  const std::filesystem::path script = data_folder() / "scripts" / "report.py";
  if (access(kPython, X_OK) != 0)
    throw io_error(kPython, "is missing, expected Debian's python3 with python3-matplotlib and python3-h5py");
  if (access(script.c_str(), R_OK) != 0)
    throw io_error(
        script.string(),
        "is missing, expected the plotting script (FURROW_HOME names the folder that holds scripts/)");
  if (const MemoryLimit limit = address_space_limit(); limit.bytes < kAddressSpace)
    throw limit_error(fmt::format("{}: plots need {:.0f} MB of memory, limit {:.0f} MB ({})", run.string(),
                                  kAddressSpace / 1e6, limit.bytes / 1e6, limit.name));
  const auto deadline = report.quiet ? std::optional(Clock::now() + kPatience) : std::nullopt;
  std::vector<std::string> command{kPython, "-I", script.string()};
  if (!report.out.empty()) command.insert(command.end(), {"--out", report.out.string()});
  command.emplace_back("--");
  for (const auto& one : report.runs) command.push_back(one.string());
  const Finished finished = run_program(std::move(command), report.quiet, deadline);
  const auto list = nlohmann::json::parse(finished.output, nullptr, false);
  if (finished.too_late)
    throw io_error(run.string(),
                   fmt::format("the plots took more than {} s; 'furrow report {}' waits for them",
                               kPatience.count(), scenario::shell_path(run.string())));
  if (!WIFEXITED(finished.status) || WEXITSTATUS(finished.status) != 0 || !list.is_array())
    throw io_error(run.string(), launch::stop_signalled() ? "the plots were interrupted"
                                 : report.quiet ? fmt::format("made no plots; 'furrow report {}' says why",
                                                              scenario::shell_path(run.string()))
                                                : "made no plots, expected the results of a run");
  std::vector<std::filesystem::path> plots;
  for (const auto& name : list)
    plots.push_back((report.out.empty() ? run : report.out) / name.get<std::string>());
  return plots;
}

std::vector<std::filesystem::path> make_report_or_warn(const std::filesystem::path& run) {
  try {
    return make_report({.runs = {run}, .quiet = true});
  } catch (const Error& error) {
    print_warning(std::string("no plots: ") + error.what());
    return {};
  }
}

}  // namespace furrow::commands
