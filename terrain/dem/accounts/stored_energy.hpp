// What contacts store where the grains stand now, from positions and histories alone: for the beginning of accounts,
// before any force was taken.
#pragma once

#include <vector>

#include "terrain/dem/accounts/contact_losses.hpp"
#include "terrain/dem/strips.hpp"
#include "terrain/dem/wall_forces.hpp"

namespace furrow::terrain::dem {

/// Of grains with radii r_i, r_j; `radius`: for which the coefficients are, m.
inline ContactCoefficients pair_coefficients(const ContactCoefficients& c, double radius, double r_i, double r_j) {
  if (r_i == radius && r_j == radius) return c;
  return scaled(c, pair_scale(r_i / radius, r_j / radius));
}

/// What the springs of the listed pair p hold since they were last evaluated, J.
double held_by_pair(const ContactCoefficients& c, const Strip& strip, int p);

/// Of the pairs and walls that each strip lists. `radius`: for which the coefficients are, m.
std::vector<Stored> stored_energy(const Grains& grains, const Strips& strips, const SolverCoefficients& c,
                                  double radius);

}  // namespace furrow::terrain::dem
