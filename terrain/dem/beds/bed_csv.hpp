// Beds from users, as text files of positions.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "protocol/core/progress_call.hpp"
#include "terrain/dem/quad.hpp"

namespace furrow::terrain::dem {

/// Reads rows `x_m,y_m,z_m` or `x_m,y_m,z_m,radius_m` (header line first), m; w: radius, 0 if the file has none.
/// @throws Error(io) when the file cannot be read, Error(bad_input) naming a line without that many finite numbers.
/// May throw what `progress` throws.
std::vector<Quad> read_positions_csv(const std::filesystem::path& file, const ProgressCall& progress = {});

/// Writes such a file, shifted by (0, y, 0), with 17 digits, and with radii if they differ. @throws Error(io)
void write_positions_csv(const std::filesystem::path& file, std::span<const Quad> positions, double y = 0.0);

}  // namespace furrow::terrain::dem
