#include "nodes/launch/signals.hpp"

#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>
#include <csignal>

#include <atomic>
#include <cerrno>

#include "nodes/launch/process_table.hpp"
#include "protocol/core/error.hpp"

namespace furrow::launch {
namespace {

constexpr useconds_t kGuardInterval = 200000;  // µs
constexpr int kStopSignals[] = {SIGTERM, SIGINT, SIGHUP, SIGUSR1};
std::atomic<int> stop_count{0};
std::atomic<bool> pause_wanted{false};
bool catching = false;
static_assert(std::atomic<int>::is_always_lock_free);  // safe in a signal handler

void count_stop(int) { stop_count.fetch_add(1, std::memory_order_relaxed); }

void end_here(int) {
  constexpr char kText[] = "furrow: error: stopped by a signal\n";
  (void)!write(2, kText, sizeof kText - 1);
  _exit(static_cast<int>(ExitCode::stopped));
}

void end_on_fault(int) {
  constexpr char kText[] =
      "furrow: error: fault of the program, in the line above; please report it as an issue, with that line\n";
  (void)!write(2, kText, sizeof kText - 1);
  _exit(static_cast<int>(ExitCode::fault));
}

void want_pause(int) { pause_wanted.store(true, std::memory_order_relaxed); }

void set_handler(int signal, void (*handler)(int)) {
  struct sigaction action = {};
  action.sa_handler = handler;
  sigemptyset(&action.sa_mask);
  sigaction(signal, &action, nullptr);  // without SA_RESTART: waiting calls return and check the flag
}

/// A user who starts a program with nohup, or in the background of a script, wants it to live on.
bool ignored(int signal) {
  struct sigaction action = {};
  return sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

}  // namespace

void end_on_stop_signals() {
  for (const int signal : kStopSignals)
    if (!ignored(signal)) set_handler(signal, end_here);
}

void end_on_abort() { set_handler(SIGABRT, end_on_fault); }

void catch_stop_signals() {
  for (const int signal : kStopSignals)
    if (!ignored(signal)) set_handler(signal, count_stop);
  set_handler(SIGPIPE, SIG_IGN);
  catching = true;
}

bool catches_stop_signals() { return catching; }

void end_on_loss_of_supervisor() {
  set_handler(SIGUSR1, [](int) { _exit(static_cast<int>(ExitCode::stopped)); });
}

int stop_signals() { return stop_count.load(std::memory_order_relaxed); }

void catch_pause() {
  if (!ignored(SIGTSTP)) set_handler(SIGTSTP, want_pause);
}

bool pause_asked() { return pause_wanted.exchange(false, std::memory_order_relaxed); }

void pause_here(const std::vector<int>& stopped) {
  const pid_t own = getpid(), guard = fork();
  if (guard == 0) {
    setpgid(0, 0);  // signals to the job do not reach this process
    while (getppid() == own) usleep(kGuardInterval);
    for (const int process : stopped) {
      for (const pid_t child : children_of(process)) kill(child, SIGCONT);
      kill(process, SIGCONT);
    }
    _exit(0);
  }
  raise(SIGSTOP);
  if (guard < 0) return;
  kill(guard, SIGKILL);
  while (waitpid(guard, nullptr, 0) < 0 && errno == EINTR) continue;
}

void restore_signals() {
  set_handler(SIGTSTP, SIG_DFL);
  for (const int signal : kStopSignals) set_handler(signal, SIG_DFL);
  set_handler(SIGPIPE, SIG_DFL);
  set_handler(SIGXFSZ, SIG_DFL);  // main.cpp; Open MPI waits forever if it is ignored
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
}

void die_with_parent(int signal, int parent) {
  prctl(PR_SET_PDEATHSIG, signal);
  if (getppid() != parent) raise(signal);
}

}  // namespace furrow::launch
