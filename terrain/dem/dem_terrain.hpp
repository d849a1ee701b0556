// The terrain made of grains behind the common interface.
#pragma once

#include "terrain/dem/dem_options.hpp"

namespace furrow::terrain {

/// @throws Error(bad_input) for values out of range and for a step above the stable one.
std::unique_ptr<Terrain> make_dem_terrain(const dem::DemOptions& options);

TerrainEstimate estimate_dem_terrain(const dem::DemOptions& options);

}  // namespace furrow::terrain
