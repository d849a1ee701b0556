// What contacts store where the grains stand now, from positions and histories alone: for the beginning of accounts,
// before any force was taken.
#pragma once

#include <vector>

#include "terrain/dem/accounts/contact_losses.hpp"
#include "terrain/dem/strips.hpp"
#include "terrain/dem/wall_forces.hpp"

namespace furrow::terrain::dem {

/// What the listed pair p remembers since it was last evaluated.
ContactHistory<double> pair_history(const Strip& strip, int p);

/// Of the pairs and walls that each strip lists. `radius`: for which the coefficients are, m.
std::vector<Stored> stored_energy(const Grains& grains, const Strips& strips, LawKind law, const SolverCoefficients& c,
                                  double radius);

}  // namespace furrow::terrain::dem
