// What the system says of processes of this machine.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace furrow::launch {

/// Processes that this one has started; ended ones of which it has not taken notice are among them. Empty where the
/// system does not tell.
std::vector<pid_t> children_of(pid_t process);

struct ProcessState {
  std::string name;  // of its program, cut to 15 bytes
  char state = '?';  // Z: it has ended, and its parent has not taken notice; ?: there is none
  pid_t parent = 0;
};
ProcessState state_of(pid_t process);

}  // namespace furrow::launch
