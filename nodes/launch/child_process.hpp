// Child processes: mpirun, the runs of a sweep, the script that plots.
#pragma once

#include <sys/types.h>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace furrow::launch {

/// The two ends of a pipe. A child inherits an end only if it is given as a stream.
struct Pipe {
  int read = -1, write = -1;
  Pipe();  // @throws Error(limit)
  ~Pipe() {
    close_read();
    close_write();
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  void close_read() { close_end(read); }
  void close_write() { close_end(write); }

 private:
  static void close_end(int& end);
};

struct Child {
  std::vector<std::string> command;    // path and arguments
  int in = -1, out = -1, err = -1;     // its standard streams; −1: those of this process
  bool own_group = false;              // signals of the terminal do not reach the child
  int death_signal = 0;                // that ends the child when this process ends
  std::function<void()> prepare = {};  // called in the child before the program begins
};

/// Checks whether mpirun, srun and the like set this variable ("NAME=value") for a rank, not the user for all runs.
bool is_of_launcher(std::string_view variable);

/// Removes from the environment the variables that mpirun, srun and the like set for their processes. A program with
/// its own launcher, or one that is not a rank, must not find them.
void forget_launcher();

/// Variables with which users choose how mpirun works: OMPI_MCA_btl and the like.
std::vector<std::string> launcher_settings();

/// @returns its process id. A program that cannot be run ends with status 127, after a line on its standard error.
/// @throws Error(limit) if no process can be made
pid_t start_child(Child child);

}  // namespace furrow::launch
