// Where a series file stood when a checkpoint was made.
#pragma once

#include <cstdint>
#include <string>

namespace furrow::checkpoint {

/// Where a series stood when a checkpoint was made.
struct SeriesMark {
  std::int64_t bytes = 0, lines = 0;  // lines of values
  std::string checksum;               // of those bytes
};

}  // namespace furrow::checkpoint
