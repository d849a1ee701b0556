// Where the grains of a bed stand before they settle: by a generator's name, or from a user's file.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "terrain/dem/bin.hpp"
#include "terrain/dem/dem_options.hpp"
#include "terrain/dem/quad.hpp"

namespace furrow::terrain::dem {

/// Spacing of the lattice and its jitter along x and along y, in grain radii: neighbours stay kSpacing apart.
inline constexpr double kLatticeSpacing = 2.3;
inline constexpr double kLatticeJitter = 0.14;

/// One layer of a square lattice, each point moved by up to ±kLatticeJitter r along x and y; every other layer is
/// shifted by half a spacing along both. z = 0. `around`: continues across periodic sides of
/// the bin, without a gap at them.
std::vector<Quad> lattice_layer(const Bin& bin, double radius, std::uint64_t seed, bool shifted, bool around = false);

/// Grains before they settle: layers by `bed_generator`, or those of the CSV file `bed`.
/// @throws Error(bad_input) listing the valid generators, or what is wrong with the file and in which line.
std::vector<Quad> starting_positions(const DemOptions& options, const ProgressCall& progress);

/// The grains of a user's `file` must be in the bin and not in each other; radii that it does not give become
/// `radius`. Lines are counted as if none were blank. @throws Error(bad_input) naming file and line, or grain
void check_positions(const DemOptions& options, const std::filesystem::path& file, std::vector<Quad>& grains,
                     const ProgressCall& progress = {});

/// How many grains starting_positions will give, without making them. @throws Error as starting_positions
double expected_grains(const DemOptions& options);

/// True when `bed` names a file that is not HDF5: positions that are settled before use.
bool is_positions_file(const std::filesystem::path& bed);

}  // namespace furrow::terrain::dem
