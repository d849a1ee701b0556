// Residual of a terrain's energy accounts.
#pragma once

#include "protocol/core/terrain_state.hpp"

namespace furrow::terrain {

/// Between two reports, J.
inline double residual(const TerrainEnergies& from, const TerrainEnergies& to) {
  return to.stored() - from.stored() + to.losses() - from.losses() - (to.surface_work - from.surface_work) -
         (to.wall_work - from.wall_work);
}

}  // namespace furrow::terrain
