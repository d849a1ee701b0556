// Positions of the grains of a bed before they settle: from a named generator, or from a user's file.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "terrain/dem/bin.hpp"
#include "terrain/dem/dem_options.hpp"
#include "terrain/dem/quad.hpp"

namespace furrow::terrain::dem {

/// Spacing of the lattice, and its jitter along x and along y, in grain radii: neighbours stay kSpacing apart.
inline constexpr double kLatticeSpacing = 2.3;
inline constexpr double kLatticeJitter = 0.14;

/// One layer of a square lattice at z = 0, each point moved by up to ±kLatticeJitter r along x and y. `shifted`: by
/// half a spacing along both. `around`: continues across periodic sides of the bin, without a gap.
std::vector<Quad> lattice_layer(const Bin& bin, double radius, std::uint64_t seed, bool shifted, bool around = false);

/// Grains before they settle: layers by `bed_generator`, or the grains of the CSV file `bed`.
/// @throws Error(bad_input) listing the valid generators, or the mistake in the file and its line.
std::vector<Quad> starting_positions(const DemOptions& options, const ProgressCall& progress);

/// Checks that the grains of a user's `file` are in the bin and not in each other; missing radii become `radius`. Line
/// numbers assume that no line is blank. @throws Error(bad_input) naming file and line, or grain
void check_positions(const DemOptions& options, const std::filesystem::path& file, std::vector<Quad>& grains,
                     const ProgressCall& progress = {});

/// Number of grains that starting_positions will give, without making them. @throws Error as starting_positions
double expected_grains(const DemOptions& options);

/// True when `bed` names a file that is not HDF5: positions that must settle before use.
bool is_positions_file(const std::filesystem::path& bed);

}  // namespace furrow::terrain::dem
