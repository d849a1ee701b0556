// Grains in LIGGGHTS behind the common interface, on any number of ranks. terrain/dem makes the bed on the leader,
// which sends it to all ranks; each rank then owns the grains of its part of the bin along x.
#pragma once

#include "terrain/dem/dem_options.hpp"

namespace furrow::terrain {

/// @throws Error(bad_input) for values out of range, for a step above the stable one, and if the engine is missing
std::unique_ptr<Terrain> make_liggghts_terrain(const dem::DemOptions& options);

}  // namespace furrow::terrain
