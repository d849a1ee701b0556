// A rank's grains as the rest of the program takes them: for heights, and for frames of all ranks.
#pragma once

#include "protocol/core/rank_group.hpp"
#include "protocol/core/terrain_state.hpp"
#include "terrain/dem/bin.hpp"
#include "terrain/dem/grains.hpp"
#include "terrain/liggghts/engine.hpp"
#include "terrain/terrain.hpp"

namespace furrow::terrain::liggghts {

/// Positions, radii and numbers.
dem::Grains grains_of(const OwnGrains& own, const dem::Bin& bin);

/// The whole frame on the leader, grains in the order of their numbers; nothing on the others.
/// @param group  null: there is one rank
void gather_frame(RankGroup* group, const OwnGrains& own, const dem::Bin& bin, TerrainFrame& out);

}  // namespace furrow::terrain::liggghts
