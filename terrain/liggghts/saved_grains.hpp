// The grains of a rank in a checkpoint: state, pairs and what they carry.
#pragma once

#include <cstdint>
#include <span>

#include "protocol/core/archive.hpp"
#include "terrain/dem/dem_options.hpp"
#include "terrain/liggghts/starting_bed.hpp"

namespace furrow::terrain::liggghts {

/// @param carried  by this rank's grains
void save_grains(Engine& engine, std::span<const CarriedBy> carried, Archive& archive);

/// @param size grains of all ranks @throws Error(io) when they do not hold together
StartingBed read_grains(const Archive& archive, std::int64_t size);

/// The grains of all parts of a checkpoint as Terrain::save of engine dem writes them, without tires.
/// @throws Error(io) when they do not hold together
Archive as_solver_state(std::span<const Archive> parts, const dem::DemOptions& options);

}  // namespace furrow::terrain::liggghts
