// Fuzzes measured roads. The first byte selects the format of the others: CSV, or OpenCRG in text or with big-endian
// numbers.
#include <cmath>

#include "protocol/core/error.hpp"
#include "terrain/rigid/roads/read_road.hpp"
#include "tests/fuzz/input_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace furrow;
  if (size == 0) return 0;
  const bool csv = data[0] == 'c';
  try {
    const terrain::ProfilePoints road =
        terrain::read_road(fuzz::input_file(csv ? "road.csv" : "road.crg", data + 1, size - 1), {.v = 0.1});
    if (road.empty() || road.size() > terrain::kMostProfilePoints) __builtin_trap();
    for (std::size_t k = 0; k < road.size(); ++k)
      if (terrain::fault_of(road, k) != terrain::ProfileFault::none || !std::isfinite(road[k][0] + road[k][1]))
        __builtin_trap();
  } catch (const Error& error) {
    if (std::string(error.what()).empty()) __builtin_trap();
  }
  return 0;
}
