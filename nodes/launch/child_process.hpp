// Programs that this one starts: mpirun, the runs of a sweep, the script that plots.
#pragma once

#include <sys/types.h>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace furrow::launch {

/// The two ends of a pipe, which children do not inherit unless they are given one as a stream.
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

/// A program to start, and what it has from the start.
struct Child {
  std::vector<std::string> command;    // path and arguments
  int in = -1, out = -1, err = -1;     // its standard streams; −1: those of this process
  bool own_group = false;              // signals of the terminal do not reach it
  int death_signal = 0;                // that ends it when this process does
  std::function<void()> prepare = {};  // called in the child before the program begins
};

/// Whether mpirun, srun and the like set this ("NAME=value") for a rank; not what users choose for all their runs.
bool is_of_launcher(std::string_view variable);

/// Takes out of the environment what mpirun, srun and the like set for the processes that they start: a program that is
/// started with a launcher of its own, or that is no rank, must not find it.
void forget_launcher();

/// Variables with which users choose how mpirun works: OMPI_MCA_btl and the like.
std::vector<std::string> launcher_settings();

/// @returns its process id. A program that cannot be run ends with status 127, after a line on its standard error.
/// @throws Error(limit) when no process can be made
pid_t start_child(Child child);

}  // namespace furrow::launch
