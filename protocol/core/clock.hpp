// The clocks that measure durations.
#pragma once

#include <chrono>
#include <ctime>

namespace furrow {

/// Wall time since some moment that all processes of one machine share, s; never set back.
inline double wall_clock() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Processor time, s. @param of CLOCK_PROCESS_CPUTIME_ID, or CLOCK_THREAD_CPUTIME_ID for the calling thread
inline double processor_time(clockid_t of) {
  timespec t{};
  clock_gettime(of, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace furrow
