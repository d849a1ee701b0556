// Processes of this machine, from the system's tables.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace furrow::launch {

/// Processes that `process` has started, including ended ones whose end it has not noticed. Empty if the system gives
/// no data.
std::vector<pid_t> children_of(pid_t process);

struct ProcessState {
  std::string name;  // of its program, cut to 15 bytes
  char state = '?';  // Z: it has ended, and its parent has not noticed; ?: there is no such process
  pid_t parent = 0;
};
ProcessState state_of(pid_t process);

}  // namespace furrow::launch
