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

/// At most `threads`, of which each has 2500 grains or more: barriers cost more than further threads save. To settle a
/// bed, two threads on two idle cores took 1.05, 0.9, 0.75 and 0.65 times as long as one for 345, 2600, 5200 and 15,900
/// grains, and up to twice the processor time. On cores that others use they take several times as long.
int useful_threads(int threads, double grains);

}  // namespace furrow::terrain
