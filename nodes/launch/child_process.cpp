#include "nodes/launch/child_process.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "nodes/launch/signals.hpp"
#include "protocol/core/error.hpp"

namespace furrow::launch {
namespace {

constexpr int kCannotRun = 127;

/// In the child: becomes the program.
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
  if (pipe2(ends, O_CLOEXEC) != 0) throw io_error("pipe", std::strerror(errno));
  read = ends[0];
  write = ends[1];
}

void Pipe::close_end(int& end) {
  if (end >= 0) close(end);
  end = -1;
}

pid_t start_child(Child child) {
  std::vector<char*> arguments;
  for (std::string& argument : child.command) arguments.push_back(argument.data());
  arguments.push_back(nullptr);
  const pid_t parent = getpid(), process = fork();
  if (process < 0)
    throw io_error(child.command.front(), std::string("cannot be started: ") + std::strerror(errno));
  if (process == 0) become(child, arguments, parent);
  if (child.own_group) setpgid(process, process);  // whoever of the two comes first
  return process;
}

}  // namespace furrow::launch
