// Energy stored in contacts at the present positions, from positions and histories alone. Accounts begin with it,
// before any force is evaluated.
#pragma once

#include <vector>

#include "terrain/dem/accounts/contact_losses.hpp"
#include "terrain/dem/strips.hpp"
#include "terrain/dem/wall_forces.hpp"

namespace furrow::terrain::dem {

/// History of the listed pair p from its last evaluation.
ContactHistory<double> pair_history(const Strip& strip, int p);

/// Energy of the pairs and walls that each strip lists. `radius`: that of the coefficients, m.
std::vector<Stored> stored_energy(const Grains& grains, const Strips& strips, LawKind law, const SolverCoefficients& c,
                                  double radius);

}  // namespace furrow::terrain::dem
