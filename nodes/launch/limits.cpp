#include "nodes/launch/limits.hpp"

#include <poll.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>
#include <csignal>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <exception>
#include <new>

#include <fmt/format.h>

#include "protocol/core/error.hpp"
#include "protocol/host.hpp"

namespace furrow::launch {
namespace {

constexpr double kRoom = 16e6;     // bytes in TMPDIR; mpirun and three ranks take 9 MB
constexpr long kFilesPerRank = 4;  // of mpirun

// Share of a limit of processor time from which the limit counts as the cause. The kernel counts whole ticks against
// the limit; on a busy core they exceed the time that it reports afterwards.
constexpr double kSurely = 0.5;

rlim_t processor_time_given = RLIM_INFINITY;  // s, before end_where_processor_time_runs_out() lowered it

/// "1 s" for a limit that is set; empty if there is none.
std::string seconds_of_processor_time(rlim_t& seconds) {
  rlimit limit{};
  if (getrlimit(RLIMIT_CPU, &limit) != 0) return {};
  seconds = processor_time_given == RLIM_INFINITY ? limit.rlim_cur : processor_time_given;
  return seconds == RLIM_INFINITY ? std::string() : fmt::format("{} s", seconds);
}

std::string too_little_processor_time(const std::string& limit) {
  return "a process may use " + limit + " of processor time (ulimit -t)";
}

constexpr useconds_t kTimeForNews = 300'000;  // µs; mpirun may drop the last output of a rank that ends at once

/// A line that is kept ready for when no memory is left to make one.
class LastWords {
 public:
  void keep(const std::string& line, int descriptor) {
    length_ = line.copy(line_.data(), line_.size());
    descriptor_ = descriptor;
  }
  bool kept() const { return length_ > 0; }
  [[noreturn]] void say_and_end() const {
    if (write(descriptor_, line_.data(), length_) > 0 && descriptor_ == STDOUT_FILENO) usleep(kTimeForNews);
    _exit(static_cast<int>(ExitCode::limit));
  }

 private:
  std::array<char, 4096> line_{};
  std::size_t length_ = 0;
  int descriptor_ = STDERR_FILENO;
};

LastWords where_memory_ran_out, where_no_thread_starts, where_processor_time_ran_out;
std::terminate_handler usual_end = nullptr;

[[noreturn]] void end_program() {
  if (const std::exception_ptr cause = std::current_exception()) try {
      std::rethrow_exception(cause);
    } catch (const std::bad_alloc&) {
      where_memory_ran_out.say_and_end();
    } catch (...) {
    }
  if (usual_end) usual_end();
  std::abort();
}

/// Called by exit(): in this program only OpenMP exits with this status.
void look_at_end(int status, void* /*unused*/) {
  if (status == EXIT_FAILURE && where_no_thread_starts.kept()) where_no_thread_starts.say_and_end();
}

}  // namespace

void require_stack(char** argv) {
  rlimit limit{};
  if (getrlimit(RLIMIT_STACK, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY || limit.rlim_cur >= kStack) return;
  const rlim_t given = limit.rlim_cur;
  limit.rlim_cur = kStack;
  limit.rlim_max = std::max<rlim_t>(limit.rlim_max, kStack);  // root may
  if (setrlimit(RLIMIT_STACK, &limit) != 0)
    throw limit_error(
        fmt::format("the stack may take {} kB (ulimit -s), expected {} kB or more", given >> 10, kStack >> 10));
  execv(this_program().c_str(), argv);
}

void require_files(std::size_t ranks) {
  const auto needed = static_cast<rlim_t>(kFiles + kFilesPerRank * static_cast<long>(ranks));
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur >= needed) return;
  const rlim_t given = limit.rlim_cur;
  limit.rlim_cur = std::min(needed, limit.rlim_max);
  if (limit.rlim_max >= needed && setrlimit(RLIMIT_NOFILE, &limit) == 0) return;
  throw limit_error(fmt::format("a process may open {} files (ulimit -n), expected {} or more to start {} ranks", given,
                                needed, ranks));
}

std::string cause_of(int signal, double processor_time, bool& certain) {
  rlim_t seconds = RLIM_INFINITY;
  const std::string limit = seconds_of_processor_time(seconds);
  const bool used_up = !limit.empty() && processor_time >= kSurely * static_cast<double>(seconds);
  certain = signal == SIGXCPU || (signal == SIGKILL && used_up);
  if (certain)
    return limit.empty() ? "a limit of processor time is reached (ulimit -t)" : too_little_processor_time(limit);
  if (signal == SIGKILL) return "the system does that when memory runs out";
  if (signal == SIGBUS) return little_room();
  return {};
}

std::string little_room() {
  const char* named = std::getenv("TMPDIR");
  const std::string folder = named && *named ? named : "/tmp";
  struct statvfs room {};
  if (statvfs(folder.c_str(), &room) != 0) return {};
  const double free = static_cast<double>(room.f_bavail) * static_cast<double>(room.f_frsize);
  if (free > kRoom) return {};
  return fmt::format("the folder for temporary files, TMPDIR {}, has room for {:.2g} MB, expected {:.2g} MB", folder,
                     1e-6 * free, 1e-6 * kRoom);
}

double processor_time_of_children() {
  rusage used{};
  if (getrusage(RUSAGE_CHILDREN, &used) != 0) return 0.0;
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(used.ru_utime) + seconds(used.ru_stime);
}

bool reader_is_gone() {
  struct stat kind {};
  pollfd end{STDOUT_FILENO, 0, 0};
  return fstat(STDOUT_FILENO, &kind) == 0 && (S_ISFIFO(kind.st_mode) || S_ISSOCK(kind.st_mode)) &&
         poll(&end, 1, 0) > 0 && (end.revents & (POLLERR | POLLHUP)) != 0;
}

void end_where_processor_time_runs_out() {
  rlimit limit{};
  if (getrlimit(RLIMIT_CPU, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return;
  processor_time_given = limit.rlim_cur;
  where_processor_time_ran_out.keep("furrow: error: " + too_little_processor_time(fmt::format("{} s", limit.rlim_cur)) +
                                        ", expected a higher limit\n",
                                    STDERR_FILENO);
  std::signal(SIGXCPU, [](int) { where_processor_time_ran_out.say_and_end(); });
  // At the upper limit the kernel kills a process without a signal first, and shells set both limits to the same value.
  if (limit.rlim_cur < limit.rlim_max || limit.rlim_cur < 2) return;
  --limit.rlim_cur;
  setrlimit(RLIMIT_CPU, &limit);
}

void end_where_memory_runs_out(const std::string& line, int descriptor) {
  where_memory_ran_out.keep(line, descriptor);
  if (std::get_terminate() != end_program) usual_end = std::set_terminate(end_program);
}

void end_where_no_thread_starts(const std::string& line, int descriptor) {
  where_no_thread_starts.keep(line, descriptor);
  on_exit(look_at_end, nullptr);  // the last registered function is called first
}

}  // namespace furrow::launch
