// The terrain made of grains behind the common interface.
#pragma once

#include <functional>

#include "terrain/dem/dem_options.hpp"

namespace furrow::terrain {

/// @throws Error(bad_input) for values out of range and for a step above the stable one.
void check_dem_run(const dem::DemOptions& options);

/// @param each_substep is called in every substep of an advance; it may throw to stop, after which the terrain is
/// unusable
/// @throws Error(bad_input) for values out of range and for a step above the stable one.
std::unique_ptr<Terrain> make_dem_terrain(const dem::DemOptions& options, std::function<void()> each_substep = {});

TerrainEstimate estimate_dem_terrain(const dem::DemOptions& options);

}  // namespace furrow::terrain
