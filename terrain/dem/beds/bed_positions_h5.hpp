// Beds that users bring as HDF5: the datasets that Furrow's own frames of grains have.
#pragma once

#include <filesystem>
#include <vector>

#include "terrain/dem/quad.hpp"

namespace furrow::terrain::dem {

/// Whether the file is HDF5; by its first bytes, whatever its name.
bool is_hdf5(const std::filesystem::path& file);

/// Reads the dataset `position` (N × 3, m) and, where there is one, `radius` (N, m; w of the result, else 0).
/// @throws Error(io) when the file cannot be read, Error(bad_input) naming the dataset or the grain that is no number.
std::vector<Quad> read_positions_h5(const std::filesystem::path& file);

}  // namespace furrow::terrain::dem
