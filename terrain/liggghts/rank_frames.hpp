// A rank's grains in the form of the rest of the program: for heights, and for frames of all ranks.
#pragma once

#include "protocol/core/rank_group.hpp"
#include "protocol/core/terrain_state.hpp"
#include "terrain/dem/bin.hpp"
#include "terrain/dem/grains.hpp"
#include "terrain/liggghts/engine.hpp"
#include "terrain/terrain.hpp"

namespace furrow::terrain::liggghts {

/// Positions, radii and numbers of the grains.
dem::Grains grains_of(const OwnGrains& own, const dem::Bin& bin);

/// Gathers the whole frame on the leader, grains in the order of their numbers; nothing on the others.
/// @param group  null if there is one rank
void gather_frame(RankGroup* group, const OwnGrains& own, const dem::Bin& bin, TerrainFrame& out);

}  // namespace furrow::terrain::liggghts
