// The deepest contacts of a bed at its present positions, before the forces of the coming step are evaluated. They
// decide how finely the bed must be stepped, and are reported if no step can integrate it. They are found from
// positions, in the few strips where the overlaps of the last step make them possible; nothing is stored.
#pragma once

#include <cstdint>
#include <string>

#include "protocol/core/vec.hpp"
#include "terrain/dem/grain_solver.hpp"

namespace furrow::terrain::dem {

struct HardContacts {
  std::int64_t count = 0;  // number of contacts with a larger overlap than the threshold
  double overlap = 0.0;    // largest overlap, m
  double coming = 0.0;     // largest overlap after `ahead` seconds if nothing slowed the approach, m
  double share = 0.0;      // largest overlap over the diameter of the smaller grain, -
  std::int64_t past = 0;   // number of contacts whose share is above kDeepestShare
  // Of the contact with the largest share:
  double deepest = 0.0;    // its overlap, m
  Vec3 at = Vec3::Zero();  // centre of its grain, m
  std::string between;     // "two grains", "a grain and the floor", …
};

/// Overlap over the grain's diameter beyond which no contact law is valid and no smaller step helps. Hertz's law
/// requires overlaps that are small against the radius; 0.3 is six times the overlap at which scenarios are checked.
inline constexpr double kDeepestShare = 0.3;

/// Contacts that now overlap by more than `above`, with surfaces at their last positions. @pre above > 0, ahead ≥ 0
HardContacts hard_contacts(const GrainSolver& solver, double above, double ahead);

}  // namespace furrow::terrain::dem
