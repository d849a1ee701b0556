#include "nodes/launch/messages.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>

namespace furrow::launch {
namespace {

std::atomic<bool> silenced = false;  // one standard error, one switch

}  // namespace

void occupy_closed_streams() {
  // open() takes the lowest free descriptor, which is one of these while any of them is free.
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(stream, F_GETFD) < 0) open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
}

void silence_messages() { silenced = true; }
bool messages_are_silenced() { return silenced; }

void say(const std::string& text) {
  if (silenced) return;
  std::fputs(text.c_str(), stderr);
  std::fflush(stderr);
}

}  // namespace furrow::launch
