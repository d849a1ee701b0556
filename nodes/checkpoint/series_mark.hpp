// Where the file of a table of results stood when a checkpoint was made.
#pragma once

#include <cstdint>
#include <string>

namespace furrow::checkpoint {

struct SeriesMark {
  std::int64_t bytes = 0, lines = 0;  // lines of values
  std::string checksum;               // of those bytes
  std::string subject;                // whose table it is: "wheel0", "vehicle"
};

}  // namespace furrow::checkpoint
