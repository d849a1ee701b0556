#include "nodes/commands/python_script.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>
#include <csignal>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <string_view>

#include <fmt/format.h>

#include "nodes/launch/child_process.hpp"
#include "nodes/launch/signals.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/data_files.hpp"
#include "protocol/files/memory_limit.hpp"

namespace furrow::commands {
namespace {

using Clock = std::chrono::steady_clock;

constexpr const char* kPython = "/usr/bin/python3";

constexpr std::string_view kShare = "progress ";  // begins a line of standard output with the share done

class Lines {
 public:
  using Call = std::function<void(const std::string& line)>;
  explicit Lines(Call call) : call_(std::move(call)) {}

  /// Reads the available text. @returns false at the end of the stream
  bool read_from(int stream) {
    std::array<char, 4096> bytes;
    const ssize_t count = read(stream, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) return true;
    if (count > 0) rest_.append(bytes.data(), static_cast<std::size_t>(count));
    std::size_t from = 0;
    for (std::size_t end; (end = rest_.find('\n', from)) != std::string::npos; from = end + 1)
      call_(rest_.substr(from, end - from));
    rest_.erase(0, from);
    if (count > 0) return true;
    if (!rest_.empty()) call_(rest_);
    return false;
  }

 private:
  Call call_;
  std::string rest_;  // a line without its end so far
};

Finished run_program(std::vector<std::string> command, const PythonScript& script) {
  launch::Pipe out, err;
  const bool watched = script.progress && script.message;
  const int nothing = open("/dev/null", O_WRONLY | O_CLOEXEC);
  const pid_t child = launch::start_child({.command = std::move(command),
                                           .out = out.write,
                                           .err = script.quiet ? nothing
                                                  : watched    ? err.write
                                                               : -1,
                                           .death_signal = SIGKILL});
  close(nothing);
  out.close_write();
  err.close_write();
  Finished finished;
  Lines printed([&](const std::string& line) {
    if (watched && line.starts_with(kShare))
      script.progress(std::strtod(line.c_str() + kShare.size(), nullptr));
    else
      finished.output += line + "\n";
  });
  Lines said([&](const std::string& line) {
    if (watched) script.message(line);
  });
  std::array<pollfd, 2> streams{pollfd{.fd = out.read, .events = POLLIN, .revents = 0},
                                pollfd{.fd = err.read, .events = POLLIN, .revents = 0}};
  while (streams[0].fd >= 0 || streams[1].fd >= 0) {  // poll() ignores negative descriptors
    const int ready = poll(streams.data(), streams.size(), script.deadline ? 500 : -1);  // ms
    if (launch::stop_signalled()) kill(child, SIGTERM);
    if (script.deadline && !finished.too_late && Clock::now() > *script.deadline) {
      finished.too_late = true;
      kill(child, SIGKILL);
    }
    if (ready <= 0) continue;
    if (streams[0].revents != 0 && !printed.read_from(streams[0].fd)) streams[0].fd = -1;
    if (streams[1].revents != 0 && !said.read_from(streams[1].fd)) streams[1].fd = -1;
  }
  out.close_read();
  err.close_read();
  while (waitpid(child, &finished.status, 0) < 0 && errno == EINTR)
    if (launch::stop_signalled()) kill(child, SIGTERM);
  return finished;
}

}  // namespace

Finished run_python(const PythonScript& script) {
  const std::filesystem::path path = data_folder() / "scripts/python/furrow/__main__.py";
  if (access(kPython, X_OK) != 0)
    throw io_error(kPython, "is missing, expected Debian's python3 with python3-matplotlib and python3-h5py");
  if (access(path.c_str(), R_OK) != 0)
    throw io_error(
        path.string(),
        fmt::format("is missing, expected the program that makes {} (FURROW_HOME names the folder that holds scripts/)",
                    script.what));
  if (const MemoryLimit limit = address_space_limit(); limit.bytes < script.address_space)
    throw limit_error(fmt::format("{}: {} need {:.0f} MB of memory, limit {:.0f} MB ({})",
                                  script.folders.front().string(), script.what, script.address_space / 1e6,
                                  limit.bytes / 1e6, limit.name));
  std::vector<std::string> command{kPython, "-I", path.string(), script.name};
  command.insert(command.end(), script.arguments.begin(), script.arguments.end());
  if (script.progress && script.message) command.emplace_back("--progress");
  command.emplace_back("--");
  for (const auto& folder : script.folders) command.push_back(folder.string());
  return run_program(std::move(command), script);
}

}  // namespace furrow::commands
