// The terrain made of grains on a GPU, behind the common interface: engine dem with `device: gpu`.
#pragma once

#include <memory>
#include <string>

#include "terrain/dem/dem_options.hpp"
#include "terrain/terrain.hpp"

namespace furrow::terrain {

/// Checks that the GPU does what the keys ask for. @throws Error(bad_input) naming the first key that it does not
void check_gpu_options(const dem::DemOptions& options);

/// @throws Error(bad_input) when there is no GPU, or it does not do what the keys ask for
std::unique_ptr<Terrain> make_gpu_terrain(const dem::DemOptions& options);

/// The GPU of this machine, its driver, its memory, and what this many grains need.
std::string gpu_text(const dem::DemOptions& options, double grains);

/// A saved state in the form that Terrain::save of engine dem writes, without tires. @throws Error(io)
Archive gpu_state_as_solver_state(const Archive& state, const dem::DemOptions& options);

}  // namespace furrow::terrain
