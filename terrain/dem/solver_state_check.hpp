// Whether a saved state of the solver holds together: a checksum that fits says nothing of who wrote the file.
#pragma once

#include "protocol/core/archive.hpp"
#include "terrain/dem/strips.hpp"

namespace furrow::terrain::dem {

/// Every length and every index that the solver follows. @param strips as the solver's options make them
/// @throws Error(io) naming the array and what is wrong with it
void check_solver_state(const Archive& archive, const Strips& strips);

}  // namespace furrow::terrain::dem
