// The sizes of a bed's grains: all alike, or spread about `radius`.
#pragma once

#include <vector>

#include "terrain/dem/quad.hpp"
#include "terrain/terrain_options.hpp"

namespace furrow::terrain::dem {

/// Largest `size_spread`: the largest grains are four times the smallest.
inline constexpr double kWidestSpread = 0.6;

/// @throws Error(bad_input) naming the key.
void check_sizes(const TerrainOptions& options);

/// Radii of the smallest and the largest grain that the options allow, m.
double smallest_radius(const TerrainOptions& options);
double largest_radius(const TerrainOptions& options);

/// The same bed with all grains of another size.
TerrainOptions of_one_size(TerrainOptions options, double radius);

/// Mean volume of a drawn grain over that of a grain of `radius`.
double mean_volume_ratio(const TerrainOptions& options);

/// Gives each grain a radius (its w, m), drawn in order from the seed.
void draw_radii(const TerrainOptions& options, std::vector<Quad>& grains);

}  // namespace furrow::terrain::dem
