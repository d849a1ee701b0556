#include "nodes/launch/messages.hpp"

#include <atomic>
#include <cstdio>

namespace furrow::launch {
namespace {

std::atomic<bool> silenced = false;  // one standard error, one switch

}  // namespace

void silence_messages() { silenced = true; }
bool messages_are_silenced() { return silenced; }

void say(const std::string& text) {
  if (silenced) return;
  std::fputs(text.c_str(), stderr);
  std::fflush(stderr);
}

}  // namespace furrow::launch
