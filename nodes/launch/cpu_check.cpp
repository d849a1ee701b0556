// This file uses no C++ library: the library's static data is not constructed yet when this code runs. The linker could
// also choose templates that were compiled elsewhere with richer instructions.
#include "nodes/launch/cpu_check.hpp"

#include <string.h>
#include <unistd.h>

#include "cpu_features.hpp"

namespace furrow::launch {
namespace {

void say(const char* text) {
  const ssize_t written = write(STDERR_FILENO, text, strlen(text));
  (void)written;
}

[[gnu::constructor(101)]] void check_processor() {
  const char* missing = missing_instruction_set();
  if (!missing) return;
  say("furrow: error: this program was built for a processor with ");
  say(missing);
  say(", which this one lacks; build it here with scripts/build.sh, or for any processor with scripts/build.sh "
      "--portable\n");
  _exit(2);
}

}  // namespace

const char* missing_instruction_set() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_cpu_init();
#define FURROW_FEATURE(name) \
  if (!__builtin_cpu_supports(name)) return name;
  FURROW_CPU_FEATURES
#undef FURROW_FEATURE
#endif
  return nullptr;
}

}  // namespace furrow::launch
