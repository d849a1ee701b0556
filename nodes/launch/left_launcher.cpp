#include "nodes/launch/left_launcher.hpp"

#include <algorithm>
#include <fstream>
#include <string>

#include "nodes/launch/child_process.hpp"
#include "nodes/launch/process_table.hpp"
#include "nodes/launch/supervisor_lines.hpp"

namespace furrow::launch {
namespace {

struct Beginning {
  std::string supervisor;  // "" if it had none
  bool is_rank = false;    // ranks have the supervisor's name too
};

/// Reads it from the environment with which a process began.
Beginning beginning_of(pid_t process) {
  const std::string name = std::string(kSupervisedVariable) + "=";
  std::ifstream file("/proc/" + std::to_string(process) + "/environ", std::ios::binary);
  Beginning found;
  for (std::string pair; std::getline(file, pair, '\0');) {
    if (pair.starts_with(name)) found.supervisor = pair.substr(name.size());
    found.is_rank = found.is_rank || is_of_launcher(pair);
  }
  return found;
}

bool lives(pid_t process) {
  const char state = state_of(process).state;
  return state != 'Z' && state != '?';
}

}  // namespace

bool is_left_launcher(pid_t process) {
  const Beginning begun = beginning_of(process);
  const ProcessState state = state_of(process);
  const std::size_t colon = begun.supervisor.rfind(':');
  const std::string self = supervisor_name();
  if (colon == std::string::npos || begun.is_rank || state.name == "srun") return false;
  const bool here = begun.supervisor.substr(0, colon) == self.substr(0, self.rfind(':'));
  const bool watched = begun.supervisor.substr(colon + 1) == std::to_string(state.parent);
  return here && !watched && std::ranges::none_of(children_of(process), lives);
}

}  // namespace furrow::launch
