// Beds from users as HDF5, with the datasets of Furrow's own frames of grains.
#pragma once

#include <filesystem>
#include <vector>

#include "terrain/dem/quad.hpp"

namespace furrow::terrain::dem {

/// Whether the file is HDF5, judged by its first bytes, whatever its name.
bool is_hdf5(const std::filesystem::path& file);

/// Reads the dataset `position` (N × 3, m) and, if there is one, `radius` (N, m; w of the result, else 0).
/// @throws Error(io) when the file cannot be read, Error(bad_input) naming the dataset or a grain that is not a number.
std::vector<Quad> read_positions_h5(const std::filesystem::path& file);

}  // namespace furrow::terrain::dem
