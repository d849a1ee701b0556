// The clock that measures durations.
#pragma once

#include <chrono>

namespace furrow {

/// Wall time since some moment that all processes of one machine share, s; never set back.
inline double wall_clock() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace furrow
