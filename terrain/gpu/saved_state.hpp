// Grains of a GPU in a checkpoint: motion and histories, exact to the bit.
#pragma once

#include "protocol/core/archive.hpp"
#include "terrain/gpu/gpu_grains.hpp"

namespace furrow::terrain::gpu {

struct SavedGrains {
  GrainMotion motion;
  Histories histories;
};

void save_grains(const GrainMotion& motion, const Histories& histories, Archive& archive);

/// @throws Error(io) when the state is damaged
SavedGrains read_grains(const Archive& archive);

}  // namespace furrow::terrain::gpu
