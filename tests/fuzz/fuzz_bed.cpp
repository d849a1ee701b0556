// Fuzzes beds of users: positions as CSV.
#include "protocol/core/error.hpp"
#include "terrain/dem/beds/bed_csv.hpp"
#include "tests/fuzz/input_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace furrow;
  try {
    terrain::dem::read_positions_csv(fuzz::input_file("bed.csv", data, size));
  } catch (const Error&) {
  }
  return 0;
}
