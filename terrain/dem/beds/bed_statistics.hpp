// Statistics of a bed at rest, from the positions of its grains.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "protocol/core/progress_call.hpp"
#include "terrain/dem/bin.hpp"
#include "terrain/dem/quad.hpp"

namespace furrow::terrain::dem {

/// Walls order the grains near them, so the middle of a bed begins at this many radii from them, at most at a quarter.
inline constexpr double kWallMargin = 8.0;

struct BedStatistics {
  std::int64_t grains = 0;
  std::int64_t pairs = 0;            // of grains that touch
  std::int64_t wall_contacts = 0;    // with walls and floor
  double coordination = 0.0;         // 2 pairs / grains: touching neighbours of a grain
  double depth = 0.0;                // mean surface height: mean over cells of 2 r of the highest grain top, m
  double top = 0.0;                  // highest grain top, m
  double solid_fraction = 0.0;       // of the box up to `depth`, doubly covered volume counted once
  double solid_fraction_bulk = 0.0;  // of its middle, depth/4 to 3 depth/4 and kWallMargin from walls, the same way
  std::array<double, 4> profile{};   // of four layers of the middle, from below
  double grain_volume = 0.0;         // of all grains, m³
  double max_overlap = 0.0;          // of two grains, m
  double median_by_mass = 0.0;       // radius up to which grains have half of the mass, m
};

/// Statistics of grains at x y z with radius w, m. `radius`: r of the cells, m. May throw what `progress` throws.
BedStatistics bed_statistics(const std::vector<Quad>& grains, const Bin& bin, double radius,
                             const ProgressCall& progress = {});

/// Volume that spheres of radii a and b share at this distance of their centres, m³:
/// π (a + b − d)² (d² + 2 d (a + b) − 3 (a − b)²) / (12 d). @pre a, b, distance > 0, or 0 for equal spheres
double lens_volume(double a, double b, double distance);

/// Volume of a sphere at height z below `height`, m³.
double volume_below(double radius, double z, double height);

}  // namespace furrow::terrain::dem
