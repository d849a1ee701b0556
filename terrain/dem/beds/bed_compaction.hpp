// Presses a flat lid on a settled bed and lifts it again.
#pragma once

#include <vector>

#include "terrain/dem/dem_options.hpp"
#include "terrain/dem/grain_solver.hpp"

namespace furrow::terrain::dem {

/// Presses a frictionless lid that fills the bin on the settled grains. The load grows to `compaction_pressure` × area,
/// stays until the lid rests, and is removed again. Side walls have no friction, as during settling, so that the
/// pressure reaches the floor. Returns the positions by grain id; contacts must settle again. @throws Error(physics)
/// when a grain is lost. @pre compaction_pressure > 0, some grains
std::vector<Quad> compacted_positions(GrainSolver& solver, const DemOptions& options, const ProgressCall& progress);

std::vector<Quad> positions_by_id(const GrainSolver& solver);

}  // namespace furrow::terrain::dem
