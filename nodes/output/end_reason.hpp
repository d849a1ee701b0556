// The reason why a complete run ended.
#pragma once

#include <cstddef>
#include <cstdint>
#include <iterator>

namespace furrow::output {

enum class EndReason : std::int32_t {
  run_end = 0,     // its planned end
  end_wall = 1,    // a wheel came near an end wall of the bin
  side_wall = 2,   // a wheel came near a side wall
  overturned = 3,  // the vehicle lies on its side
};

/// The name in results: "run_end", "end_wall", "side_wall", "overturned".
inline const char* to_string(EndReason reason) {
  constexpr const char* kNames[] = {"run_end", "end_wall", "side_wall", "overturned"};
  const auto place = static_cast<std::size_t>(reason);
  return kNames[place < std::size(kNames) ? place : 0];
}

}  // namespace furrow::output
