// Whether a saved state of the solver holds together: a checksum that fits says nothing of who wrote the file.
#pragma once

#include <cstdint>

#include "protocol/core/archive.hpp"
#include "terrain/dem/strips.hpp"

namespace furrow::terrain::dem {

/// Every length and every index that the solver follows. @param strips as the solver's options make them
/// @param smallest, largest radii of the grains that the solver takes, m
/// @throws Error(io) naming the array and what is wrong with it
void check_solver_state(const Archive& archive, const Strips& strips, double smallest, double largest);

/// Into how many parcels the strips of a saved state are cut, by its array kAcross.
inline constexpr char kAcross[] = "parcels/across";
std::int64_t saved_across(const Archive& archive);
/// A bed that is read may be cut otherwise: it wakes. A run that is continued may not.
/// @throws Error(io) naming the array
void require_same_parcels(const Archive& archive, const Strips& strips);

}  // namespace furrow::terrain::dem
