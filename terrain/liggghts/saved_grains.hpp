// The grains of a rank in a checkpoint: state, pairs and carried histories.
#pragma once

#include <cstdint>
#include <span>

#include "protocol/core/archive.hpp"
#include "terrain/dem/dem_options.hpp"
#include "terrain/liggghts/starting_bed.hpp"

namespace furrow::terrain::liggghts {

/// @param carried  by this rank's grains
void save_grains(Engine& engine, std::span<const CarriedBy> carried, Archive& archive);

/// @param size number of grains of all ranks @throws Error(io) when the parts do not fit together
StartingBed read_grains(const Archive& archive, std::int64_t size);

/// Joins the grains of all parts of a checkpoint to the form that Terrain::save of engine dem writes, without tires.
/// @throws Error(io) when the parts do not fit together
Archive as_solver_state(std::span<const Archive> parts, const dem::DemOptions& options);

}  // namespace furrow::terrain::liggghts
