// Beds that users bring: a text file of positions.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "terrain/dem/lanes.hpp"

namespace furrow::dem {

/// Reads rows `x_m,y_m,z_m` (header line first), m.
/// @throws Error(io) when the file cannot be read, Error(bad_input) naming the line that is not three finite numbers.
std::vector<Quad> read_positions_csv(const std::filesystem::path& file);

/// Writes such a file, shifted by (0, y, 0), 17 digits. @throws Error(io)
void write_positions_csv(const std::filesystem::path& file, std::span<const Quad> positions, double y = 0.0);

}  // namespace furrow::dem
