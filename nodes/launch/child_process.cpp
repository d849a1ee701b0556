#include "nodes/launch/child_process.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "nodes/launch/signals.hpp"
#include "protocol/core/error.hpp"

namespace furrow::launch {
namespace {

constexpr int kCannotRun = 127;

/// Replaces the child process by the program.
[[noreturn]] void become(const Child& child, const std::vector<char*>& arguments, pid_t parent) {
  if (child.own_group) setpgid(0, 0);
  die_with_parent(child.death_signal, parent);
  restore_signals();
  if (child.in >= 0) dup2(child.in, STDIN_FILENO);
  if (child.out >= 0) dup2(child.out, STDOUT_FILENO);
  if (child.err >= 0) dup2(child.err, STDERR_FILENO);
  if (child.prepare) child.prepare();
  execv(arguments.front(), arguments.data());
  dprintf(STDERR_FILENO, "%s cannot be run: %s\n", arguments.front(), std::strerror(errno));
  _exit(kCannotRun);
}

}  // namespace

Pipe::Pipe() {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0)
    throw limit_error(std::string("a pipe cannot be opened: ") + std::strerror(errno) + " (ulimit -n)");
  read = ends[0];
  write = ends[1];
}

void Pipe::close_end(int& end) {
  if (end >= 0) close(end);
  end = -1;
}

bool is_of_launcher(std::string_view variable) {
  constexpr std::array kBeginnings{"OMPI_COMM_WORLD_",
                                   "OMPI_UNIVERSE_",
                                   "OMPI_APP_CTX_",
                                   "OMPI_NUM_APP_CTX",
                                   "OMPI_FIRST_RANKS",
                                   "OMPI_FILE_LOCATION",
                                   "OMPI_COMMAND",
                                   "OMPI_ARGV",
                                   "OMPI_MCA_ess=",
                                   "OMPI_MCA_ess_base_",
                                   "OMPI_MCA_initial_wdir",
                                   "OMPI_MCA_mpi_oversubscribe",
                                   "OMPI_MCA_orte_app_num",
                                   "OMPI_MCA_orte_bound_at_launch",
                                   "OMPI_MCA_orte_ess_",
                                   "OMPI_MCA_orte_hnp_uri",
                                   "OMPI_MCA_orte_jobfam_",
                                   "OMPI_MCA_orte_jobid",
                                   "OMPI_MCA_orte_launch=",
                                   "OMPI_MCA_orte_local_daemon_uri",
                                   "OMPI_MCA_orte_num_nodes",
                                   "OMPI_MCA_orte_precondition_",
                                   "OMPI_MCA_orte_top_session_",
                                   "OMPI_MCA_pmix=",
                                   "OMPI_MCA_shmem_RUNTIME_",
                                   "PMIX_",
                                   "PMI_"};
  return !variable.starts_with("PMIX_MCA_") &&
         std::any_of(kBeginnings.begin(), kBeginnings.end(),
                     [&](const char* beginning) { return variable.starts_with(beginning); });
}

void forget_launcher() {
  std::vector<std::string> names;
  for (char** entry = environ; *entry; ++entry)
    if (const std::string_view variable(*entry); is_of_launcher(variable))
      names.emplace_back(variable.substr(0, variable.find('=')));
  for (const std::string& name : names) unsetenv(name.c_str());
}

std::vector<std::string> launcher_settings() {
  constexpr std::array kChosen{"OMPI_MCA_", "PMIX_MCA_", "OPAL_", "MPIEXEC_"};
  std::vector<std::string> names;
  for (char** entry = environ; *entry; ++entry) {
    const std::string_view variable(*entry);
    const bool chosen = std::any_of(kChosen.begin(), kChosen.end(),
                                    [&](const char* beginning) { return variable.starts_with(beginning); });
    if (chosen && !is_of_launcher(variable)) names.emplace_back(variable.substr(0, variable.find('=')));
  }
  std::sort(names.begin(), names.end());
  return names;
}

pid_t start_child(Child child) {
  std::vector<char*> arguments;
  for (std::string& argument : child.command) arguments.push_back(argument.data());
  arguments.push_back(nullptr);
  const pid_t parent = getpid(), process = fork();
  if (process < 0)
    throw limit_error(child.command.front() + ": cannot be started: " + std::strerror(errno) +
                      " (ulimit -u, ulimit -v, or no memory)");
  if (process == 0) become(child, arguments, parent);
  if (child.own_group) setpgid(process, process);  // parent and child both call this; the first call takes effect
  return process;
}

}  // namespace furrow::launch
