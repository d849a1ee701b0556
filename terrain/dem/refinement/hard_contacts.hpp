// The deepest contacts of a bed as it stands now, before the forces of the coming step are taken: what decides how
// finely the bed must be stepped, and what is reported where no step can integrate it. Found again from positions, in
// the few strips where the overlaps of the last step leave them possible; nothing is kept.
#pragma once

#include <cstdint>
#include <string>

#include "protocol/core/vec.hpp"
#include "terrain/dem/grain_solver.hpp"

namespace furrow::terrain::dem {

struct HardContacts {
  std::int64_t count = 0;  // of the contacts that overlap by more than was asked for
  double overlap = 0.0;    // the largest, m
  double coming = 0.0;     // the largest after `ahead` seconds if nothing slowed the approach, m
  double share = 0.0;      // the largest overlap over the diameter of the smaller grain, -
  std::int64_t past = 0;   // of the contacts whose share is above kDeepestShare
  // Of the contact with the largest share:
  double deepest = 0.0;    // its overlap, m
  Vec3 at = Vec3::Zero();  // centre of its grain, m
  std::string between;     // "two grains", "a grain and the floor", …
};

/// Share of its diameter beyond which no law of contact holds and no step helps. Hertz's law is for overlaps that are
/// small beside the radius; 0.3 is six times the overlap for which scenarios are checked.
inline constexpr double kDeepestShare = 0.3;

/// Those that overlap by more than `above` now, with surfaces where they were last moved. @pre above > 0, ahead ≥ 0
HardContacts hard_contacts(const GrainSolver& solver, double above, double ahead);

}  // namespace furrow::terrain::dem
