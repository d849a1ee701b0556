// The plots of a run, made by scripts/report.py with Debian's own Python, whatever python stands first on PATH, and
// isolated (-I) from what the user's environment and folders have for Python.
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>
#include <csignal>

#include <array>
#include <cerrno>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "nodes/commands/commands.hpp"
#include "nodes/launch/child_process.hpp"
#include "nodes/launch/run_directory.hpp"
#include "nodes/launch/signals.hpp"
#include "nodes/scenario/rank_table.hpp"
#include "protocol/files/data_files.hpp"

namespace furrow::commands {
namespace {

constexpr const char* kPython = "/usr/bin/python3";

struct Finished {
  int status = 0;      // of waitpid
  std::string output;  // standard output
};

/// Runs a program to its end; a stop signal ends it.
Finished run_program(std::vector<std::string> command, bool quiet) {
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
  for (ssize_t count; (count = read(pipe.read, bytes.data(), bytes.size())) != 0;) {
    if (count > 0)
      finished.output.append(bytes.data(), static_cast<std::size_t>(count));
    else if (errno != EINTR)
      break;
    if (launch::stop_signalled()) kill(child, SIGTERM);
  }
  pipe.close_read();
  while (waitpid(child, &finished.status, 0) < 0 && errno == EINTR)
    if (launch::stop_signalled()) kill(child, SIGTERM);
  return finished;
}

}  // namespace

std::vector<std::filesystem::path> make_report(const std::filesystem::path& run, bool quiet) {
  launch::require_run_directory(run);
  const std::filesystem::path script = data_folder() / "scripts" / "report.py";
  if (access(kPython, X_OK) != 0)
    throw io_error(kPython, "is missing, expected Debian's python3 with python3-matplotlib and python3-h5py");
  if (access(script.c_str(), R_OK) != 0)
    throw io_error(
        script.string(),
        "is missing, expected the plotting script (FURROW_HOME names the folder that holds scripts/)");
  const Finished finished = run_program({kPython, "-I", script.string(), "--", run.string()}, quiet);
  const auto list = nlohmann::json::parse(finished.output, nullptr, false);
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
