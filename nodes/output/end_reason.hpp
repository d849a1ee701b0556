// Why a run that is complete ended where it did.
#pragma once

#include <cstdint>

namespace furrow::output {

enum class EndReason : std::int32_t {
  run_end = 0,    // its planned end
  end_wall = 1,   // a wheel came near an end wall of the bin
  side_wall = 2,  // or a side wall
};

/// As results say it: "run_end", "end_wall", "side_wall".
inline const char* to_string(EndReason reason) {
  if (reason == EndReason::end_wall) return "end_wall";
  return reason == EndReason::side_wall ? "side_wall" : "run_end";
}

}  // namespace furrow::output
