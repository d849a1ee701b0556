#include "nodes/launch/supervisor.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>
#include <csignal>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <optional>
#include <sstream>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "nodes/launch/child_process.hpp"
#include "nodes/launch/end_watch.hpp"
#include "nodes/launch/limits.hpp"
#include "nodes/launch/signals.hpp"
#include "nodes/launch/start_watch.hpp"
#include "nodes/launch/supervisor_lines.hpp"
#include "nodes/launch/supervisor_text.hpp"
#include "nodes/launch/thread_setup.hpp"
#include "nodes/scenario/memory_check.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/core/clock.hpp"
#include "protocol/files/memory_limit.hpp"
#include "protocol/host.hpp"

namespace furrow::launch {
namespace {

constexpr const char* kTooManyProcesses = "system limit exceeded on number of processes";  // Open MPI
constexpr double kStopPatience = 300.0;  // s from the request to stop until mpirun is terminated: time for a checkpoint
constexpr double kStartPatience = 20.0;  // s that a stop waits for ranks that are still starting
constexpr double kKillPatience = 5.0;    // s from that until it is killed
constexpr double kEndPatience = 10.0;    // s from the end of all ranks until mpirun is killed
constexpr double kFailurePatience = 20.0;  // s from a failure until mpirun is killed, plus peer_timeout
constexpr double kScarce = 0.5e9;          // bytes of address space: MPI may not begin with so little
constexpr double kDrainPatience = 1.0;     // s to read what is left once mpirun has ended
constexpr double kLogInterval = 5.0;       // s between lines of progress in the log
constexpr int kPollInterval = 100;         // ms

/// Cuts what a pipe delivers into lines.
class Lines {
 public:
  template <class Use>
  void add(const char* bytes, std::size_t count, const Use& use) {
    rest_.append(bytes, count);
    std::size_t from = 0;
    for (std::size_t end; (end = rest_.find('\n', from)) != std::string::npos; from = end + 1)
      use(std::string_view(rest_).substr(from, end - from));
    rest_.erase(0, from);
  }

 private:
  std::string rest_;
};

bool memory_is_scarce() { return address_space_limit().bytes < kScarce; }

/// The text, and that the folder for temporary files has little room, if so.
std::string with_little_room(const std::string& text) {
  const std::string little = little_room();
  return little.empty() ? text : text + "; " + little;
}

LaunchResult out_of_memory(const std::string& text) {
  return {ExitCode::limit, fmt::format("{}: {}", scenario::out_of_memory(0.0).what(), text)};
}

/// Checks whether somebody ended mpirun, or a rank before MPI had registered it; mpirun returns its death like a shell.
bool was_killed(int status) {
  constexpr int kBySignal = 128;
  const int signal = WIFEXITED(status) ? WEXITSTATUS(status) - kBySignal : WTERMSIG(status);
  return signal == SIGKILL || signal == SIGTERM;
}

std::string signal_name(int signal) {
  const char* name = strsignal(signal);
  return fmt::format("killed by signal {} ({})", signal, name ? name : "unknown");
}

std::vector<std::string> launcher_command(const Launch& launch) {
  FURROW_ASSERT(!launch.ranks.empty(), launch.ranks.size());
  const std::filesystem::path launcher = find_mpirun();
  std::vector<std::string> command{launcher.string()};
  if (launcher.filename() == "srun") {  // passes the environment on
    command.insert(command.end(), {"--mpi=pmix", "-K1", "--cpu-bind=none", "--overcommit"});
  } else {
    command.insert(command.end(), {"--oversubscribe", "--bind-to", "none"});
    if (geteuid() == 0) command.push_back("--allow-run-as-root");  // supervise() reports it
    // Ranks on other machines of an allocation do not inherit the environment.
    for (const char* variable : {kSupervisedVariable, "OMP_WAIT_POLICY", "GOMP_SPINCOUNT", "OPENBLAS_NUM_THREADS"})
      command.insert(command.end(), {"-x", variable});
  }
  command.insert(command.end(), {"-n", std::to_string(launch.ranks.size())});
  command.push_back(this_program().string());
  command.insert(command.end(), launch.arguments.begin(), launch.arguments.end());
  return command;
}

std::optional<std::filesystem::path> on_path(const std::string& program) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "/usr/bin:/bin");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::filesystem::path candidate = std::filesystem::path(folder.empty() ? "." : folder) / program;
    if (access(candidate.c_str(), X_OK) == 0) return candidate;
  }
  return std::nullopt;
}

void set_environment(const std::string& supervisor, bool yield) {
  forget_launcher();
  setenv(kSupervisedVariable, supervisor.c_str(), 1);
  setenv("OMPI_MCA_orte_forward_job_control", "1", 0);        // mpirun passes stops and continuations on
  if (yield) setenv("OMPI_MCA_mpi_yield_when_idle", "1", 0);  // otherwise protocol/mpi_yield.hpp
  // Open MPI does not begin without a way to other machines, even if it needs none.
  if (!on_path("ssh") && !on_path("rsh")) setenv("OMPI_MCA_plm_rsh_agent", "/bin/false", 0);
  set_passive_environment();
}

class Supervisor {
 public:
  Supervisor(const Launch& launch, ProgressDisplay& display)
      : launch_(launch),
        display_(display),
        log_(launch.log, std::ios::app),
        start_(launch.ranks.size(), launch.patience),
        end_(launch.ranks.size(), kEndPatience, launch.peer_timeout + kFailurePatience) {
    if (!log_) throw io_error(launch.log.string(), "cannot be written");
  }
  ~Supervisor() {
    if (!reaped_ && child_ > 0) {
      kill(-child_, SIGKILL);
      waitpid(child_, nullptr, 0);
    }
  }

  LaunchResult run() {
    start();
    while (!(reaped_ && (both_closed() || wall_clock() - reaped_at_ > kDrainPatience))) {
      read_some();
      reap();
      if (reaped_) continue;
      pass_on_stop();
      pass_on_pause();
      end_late_start();
      end_hung_launcher();
      if (ended_ > 0.0 && wall_clock() - ended_ > kKillPatience) kill(-child_, SIGKILL);
    }
    kill(-child_, SIGKILL);  // the rest of its group
    display_.clear();
    LaunchResult result = outcome();
    result.started = start_.count();
    if (!result.error.empty()) log_ << result.error << '\n';
    return result;
  }

 private:
  void start();
  void read_some();
  void take_output(std::string_view line);
  void take_error_text(std::string_view line) {
    log_ << line << '\n';
    launcher_.add(line);
  }
  void reap();
  void pass_on_stop();
  void pass_on_pause();
  void end_late_start();
  void end_hung_launcher();
  LaunchResult outcome() const;
  std::string launcher_said() const;
  LaunchResult lost_rank(int rank, const std::string& how) const;
  bool both_closed() const { return out_.read < 0 && err_.read < 0; }

  const Launch& launch_;
  ProgressDisplay& display_;
  std::ofstream log_;
  Pipe out_, err_;
  Lines out_lines_, err_lines_;
  LauncherText launcher_, other_;  // standard error, and standard output without the ranks' lines
  StartWatch start_;
  EndWatch end_;
  std::optional<RankLine> error_;  // the first; one with a cause replaces one that reports a loss
  pid_t child_ = -1;
  bool reaped_ = false, late_ = false, hung_ = false;
  int status_ = 0;
  double logged_ = 0.0;  // wall time of the last progress in the log, s
  double reaped_at_ = 0.0, stop_seen_ = 0.0, asked_ = 0.0, ended_ = 0.0;  // wall time, s; 0: not yet
};

void Supervisor::start() {
  const bool polls_share_cores = launch_.polling > allowed_cores().size();
  const int nothing = open("/dev/null", O_RDONLY | O_CLOEXEC);
  // When this process is killed, the ranks save their state and stop: mpirun passes USR1 on at once. It passes TERM on
  // after two seconds, in which the ranks would continue.
  child_ = start_child({.command = launcher_command(launch_),
                        .in = nothing,
                        .out = out_.write,
                        .err = err_.write,
                        .own_group = true,
                        .death_signal = SIGUSR1,
                        .prepare = [hold = launch_.hold, yield = polls_share_cores, self = supervisor_name()] {
                          set_environment(self, yield);
                          if (hold >= 0) fcntl(hold, F_SETFD, 0);
                        }});
  close(nothing);
  out_.close_write();
  err_.close_write();
}

void Supervisor::read_some() {
  std::array<pollfd, 2> ends{pollfd{out_.read, POLLIN, 0}, pollfd{err_.read, POLLIN, 0}};
  if (poll(ends.data(), ends.size(), kPollInterval) <= 0) return;
  std::array<char, 1 << 16> bytes;
  for (Pipe* pipe : {&out_, &err_}) {
    if (!(ends[pipe == &err_].revents & (POLLIN | POLLHUP | POLLERR))) continue;
    const ssize_t count = read(pipe->read, bytes.data(), bytes.size());
    if (count == 0) pipe->close_read();
    if (count <= 0) continue;
    const auto size = static_cast<std::size_t>(count);
    if (pipe == &out_)
      out_lines_.add(bytes.data(), size, [this](std::string_view line) { take_output(line); });
    else
      err_lines_.add(bytes.data(), size, [this](std::string_view line) { take_error_text(line); });
  }
}

void Supervisor::take_output(std::string_view text) {
  const auto line = decode(text);
  if (!line) {
    log_ << text << '\n';
    other_.add(text);
    return;
  }
  switch (line->kind) {
    case RankLine::Kind::begun:
      start_.begun(line->rank);
      break;
    case RankLine::Kind::read:
      start_.read(line->rank);
      break;
    case RankLine::Kind::started:
      start_.started(line->rank);
      break;
    case RankLine::Kind::ended:
      end_.ended(line->rank, line->code);
      break;
    case RankLine::Kind::progress:
      if (asked_ == 0.0) display_.show(line->progress);
      if (const double now = wall_clock(); now - logged_ >= kLogInterval) {
        logged_ = now;
        log_ << progress_text(line->progress) << '\n';
      }
      break;
    case RankLine::Kind::note:
      display_.say("furrow: " + line->text);
      log_ << line->text << '\n';
      break;
    case RankLine::Kind::error:
      log_ << fmt::format("rank {}: {}\n", line->rank, line->text);
      if (!error_ || (error_->code == ExitCode::rank_lost && line->code != ExitCode::rank_lost)) error_ = line;
      end_.failed();
      break;
  }
  log_.flush();
}

void Supervisor::reap() {
  if (reaped_) return;
  const pid_t ended = waitpid(child_, &status_, WNOHANG);
  if (ended == 0 || (ended < 0 && errno == EINTR)) return;
  if (ended < 0) status_ = SIGKILL;  // the child no longer exists, and nothing shows how it ended
  reaped_ = true;
  reaped_at_ = wall_clock();
}

void Supervisor::pass_on_stop() {
  const int stops = stop_signals();
  if (stops == 0) return;
  const double now = wall_clock();
  if (stop_seen_ == 0.0) {
    stop_seen_ = now;
    display_.say("furrow: stopping; once more to stop at once");
  }
  const bool all_started = start_.all_started();
  // A rank that does not catch its signals yet would die of USR1.
  if (asked_ == 0.0 && (all_started || now - stop_seen_ > kStartPatience)) {
    asked_ = now;
    kill(child_, all_started ? SIGUSR1 : SIGTERM);
    if (!all_started) ended_ = now;
  }
  const bool impatient = stops > 1 && now - stop_seen_ > 0.5;
  if (ended_ == 0.0 && (impatient || (asked_ > 0.0 && now - asked_ > kStopPatience))) {
    ended_ = now;
    kill(child_, SIGTERM);
  }
}

/// Only this process receives Ctrl-Z: the ranks have a group of their own.
void Supervisor::pass_on_pause() {
  if (!pause_asked()) return;
  display_.clear();
  kill(child_, SIGTSTP);
  pause_here({child_});
  kill(child_, SIGCONT);
}

void Supervisor::end_late_start() {
  if (late_ || ended_ > 0.0 || !start_.too_late()) return;
  late_ = true;
  ended_ = wall_clock();
  kill(child_, SIGTERM);
}

/// The launcher's task is done: its ranks have ended.
void Supervisor::end_hung_launcher() {
  if (launcher_.lost()) end_.failed();
  if (hung_ || reaped_ || !end_.too_late(child_)) return;
  hung_ = true;
  log_ << "mpirun did not end although its ranks had; it is killed" << std::endl;
  kill(-child_, SIGKILL);
}

std::string Supervisor::launcher_said() const {
  const std::string words = launcher_.words().empty() ? other_.words() : launcher_.words();
  return words.empty() ? "said nothing" : "said: " + words;
}

LaunchResult Supervisor::lost_rank(int rank, const std::string& how) const {
  const auto index = static_cast<std::size_t>(rank);
  const std::string node = index < launch_.ranks.size() ? " (" + launch_.ranks[index].node + ")" : "";
  return {ExitCode::rank_lost, fmt::format("rank {}{} was lost: {}", rank, node, how)};
}

LaunchResult Supervisor::outcome() const {
  const bool exited = WIFEXITED(status_);
  const int status = exited ? WEXITSTATUS(status_) : -1;
  if (late_ && stop_seen_ == 0.0) {
    const std::string said = launcher_said();
    const std::string text =
        with_little_room(fmt::format("{} within {:g} s (FURROW_START_TIMEOUT sets another time): mpirun {}",
                                     start_.standing(), launch_.patience, said));
    if (said.find(std::strerror(ENOMEM)) == std::string::npos && !memory_is_scarce()) return {ExitCode::io, text};
    return out_of_memory(text);
  }
  if (error_ && error_->code != ExitCode::rank_lost) return {error_->code, error_->text};
  const bool told_all = hung_ && end_.all_ended();  // the ranks gave all that mpirun's status would give
  if (told_all && end_.code() == ExitCode::done) return {};
  const bool stopped = told_all ? end_.code() == ExitCode::stopped : status == static_cast<int>(ExitCode::stopped);
  if (stop_seen_ > 0.0 && (stopped || ended_ > 0.0))
    return {ExitCode::stopped,
            ended_ > 0.0 ? "stopped by a signal before the ranks could finish" : "stopped by a signal"};
  if (!launcher_.fault().empty()) {
    const Error fault = fault_error(launcher_.fault());
    return {fault.code(), fault.what()};
  }
  if (launcher_.lost()) {
    const int signal = launcher_.lost()->signal;
    bool limit = false;
    const std::string cause = cause_of(signal, processor_time_of_children(), limit);
    LaunchResult lost = lost_rank(launcher_.lost()->rank, signal_name(signal) + (cause.empty() ? "" : "; " + cause));
    if (limit) lost.code = ExitCode::limit;
    return lost;
  }
  if (error_) return {error_->code, error_->text};
  if (status == 0 && start_.all_started()) return {};
  const std::string how = hung_    ? "mpirun did not end although its ranks had"
                          : exited ? fmt::format("mpirun ended with status {}", status)
                                   : "mpirun was " + signal_name(WTERMSIG(status_));
  const std::string text = how + " and " + launcher_said();
  if (start_.count() > 0) return {ExitCode::rank_lost, text};
  if (text.find(kTooManyProcesses) != std::string::npos) return {ExitCode::limit, "no rank could be started: " + text};
  if (was_killed(status_)) return {ExitCode::rank_lost, "the ranks were lost while they were being started: " + text};
  if (memory_is_scarce()) return out_of_memory("no rank could be started: " + text);
  std::vector<std::string> suspects = launcher_settings();
  suspects.insert(suspects.begin(), {"PATH", "TMPDIR"});
  return {ExitCode::io, fmt::format("no rank could be started (are {} right, is FURROW_MPIRUN Open MPI's?): {}",
                                    fmt::join(suspects, ", "), with_little_room(text))};
}

}  // namespace

std::filesystem::path find_mpirun() {
  if (const char* wanted = std::getenv("FURROW_MPIRUN"); wanted && *wanted) {
    if (access(wanted, X_OK) == 0) return wanted;
    throw io_error(wanted, "is not a program that can be run, but FURROW_MPIRUN names it; expected Open MPI's mpirun");
  }
  if (access(FURROW_MPIEXEC, X_OK) == 0) return FURROW_MPIEXEC;
  if (const auto found = on_path("mpirun")) return *found;
  throw io_error("mpirun", "is not installed, expected Open MPI's on PATH (Debian package openmpi-bin)");
}

LaunchResult supervise(const Launch& launch, ProgressDisplay& display) {
  FURROW_ASSERT(catches_stop_signals());
  catch_pause();
  if (geteuid() == 0) display.say("furrow: runs as root, with Open MPI's option --allow-run-as-root");
  return Supervisor(launch, display).run();
}

}  // namespace furrow::launch
