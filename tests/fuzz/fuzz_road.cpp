// Fuzzes measured roads and height maps. The first byte selects the format of the others: CSV, a grid in ASCII, or
// OpenCRG in text or with big-endian numbers. OpenCRG is read once straight and once along its reference line.
#include <cmath>

#include "protocol/core/error.hpp"
#include "terrain/rigid/ground_shape.hpp"
#include "terrain/rigid/roads/read_road.hpp"
#include "tests/fuzz/input_file.hpp"

namespace {

using namespace furrow;

void read_profile(const std::filesystem::path& file) {
  const terrain::ProfilePoints road = terrain::read_road(file, {.v = 0.1});
  if (road.empty() || road.size() > terrain::kMostProfilePoints) __builtin_trap();
  for (std::size_t k = 0; k < road.size(); ++k)
    if (terrain::fault_of(road, k) != terrain::ProfileFault::none || !std::isfinite(road[k][0] + road[k][1]))
      __builtin_trap();
}

void read_heights(const std::filesystem::path& file, bool curved) {
  const terrain::GroundShape shape = terrain::read_shape(file, {.v = 0.1, .curved = curved}, true);
  shape.remarks();
  const terrain::UnevenPart part = shape.uneven();
  if (curved && !(part.from <= part.to && part.right <= part.left)) __builtin_trap();
  const GroundHeights heights = shape.heights();
  for (const double x : {-1.0, 2.0, 2.5, 3.7, 1e6})
    for (const double y : {-1e6, -0.3, 0.0, 0.4})
      if (!std::isfinite(heights(x, y))) __builtin_trap();
}

template <class Read>
void try_to(const Read& read) {
  try {
    read();
  } catch (const Error& error) {
    if (std::string(error.what()).empty()) __builtin_trap();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const bool crg = data[0] != 'c' && data[0] != 'a';
  const auto file = fuzz::input_file(crg ? "road.crg" : data[0] == 'c' ? "road.csv" : "road.asc", data + 1, size - 1);
  try_to([&] { read_profile(file); });
  try_to([&] { read_heights(file, false); });
  if (crg) try_to([&] { read_heights(file, true); });
  return 0;
}
