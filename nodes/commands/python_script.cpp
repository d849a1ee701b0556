#include "nodes/commands/python_script.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>
#include <csignal>

#include <array>
#include <cerrno>

#include <fmt/format.h>

#include "nodes/launch/child_process.hpp"
#include "nodes/launch/signals.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/data_files.hpp"
#include "protocol/memory_limit.hpp"

namespace furrow::commands {
namespace {

using Clock = std::chrono::steady_clock;

constexpr const char* kPython = "/usr/bin/python3";

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

Finished run_python(const PythonScript& script) {
  const std::filesystem::path path = data_folder() / "scripts" / script.name;
  if (access(kPython, X_OK) != 0)
    throw io_error(kPython, "is missing, expected Debian's python3 with python3-matplotlib and python3-h5py");
  if (access(path.c_str(), R_OK) != 0)
    throw io_error(path.string(), fmt::format("is missing, expected the script that makes {} (FURROW_HOME "
                                              "names the folder that holds scripts/)",
                                              script.what));
  if (const MemoryLimit limit = address_space_limit(); limit.bytes < script.address_space)
    throw limit_error(fmt::format("{}: {} need {:.0f} MB of memory, limit {:.0f} MB ({})",
                                  script.folders.front().string(), script.what, script.address_space / 1e6,
                                  limit.bytes / 1e6, limit.name));
  std::vector<std::string> command{kPython, "-I", path.string()};
  command.insert(command.end(), script.arguments.begin(), script.arguments.end());
  command.emplace_back("--");
  for (const auto& folder : script.folders) command.push_back(folder.string());
  return run_program(std::move(command), script.quiet, script.deadline);
}

}  // namespace furrow::commands
