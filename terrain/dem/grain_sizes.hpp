// The sizes of a bed's grains: all equal, or spread about `radius`.
#pragma once

#include <vector>

#include "terrain/dem/dem_options.hpp"
#include "terrain/dem/quad.hpp"

namespace furrow::terrain::dem {

/// @throws Error(bad_input) naming the key.
void check_sizes(const DemOptions& options);

/// Radii of the smallest and the largest grain that the options allow, m.
double smallest_radius(const DemOptions& options);
double largest_radius(const DemOptions& options);

/// The same bed with all grains of one size.
DemOptions of_one_size(DemOptions options, double radius);

/// Mean volume of a drawn grain over that of a grain of `radius`.
double mean_volume_ratio(const DemOptions& options);

/// Grains up to this radius have half of the mass of all drawn grains, m. `radius` is the median by number.
double median_radius_by_mass(const DemOptions& options);

/// Gives each grain a radius (its w, m), drawn in order, starting from the seed.
void draw_radii(const DemOptions& options, std::vector<Quad>& grains);

}  // namespace furrow::terrain::dem
