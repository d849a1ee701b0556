// Checks that a saved state of the solver is consistent: a valid checksum does not prove who wrote the file.
#pragma once

#include <cstdint>

#include "protocol/core/archive.hpp"
#include "terrain/dem/strips.hpp"

namespace furrow::terrain::dem {

/// Checks every length and every index that the solver follows. @param strips as made by the solver's options
/// @param smallest, largest radii of grains that the solver allows, m
/// @throws Error(io) naming the array and what is wrong with it
void check_solver_state(const Archive& archive, const Strips& strips, double smallest, double largest);

/// Name of the array with the number of parcels into which the strips of a saved state are cut.
inline constexpr char kAcross[] = "parcels/across";
std::int64_t saved_across(const Archive& archive);
/// A bed that is read may be cut into other parcels and then wakes; a continued run must have the same parcels.
/// @throws Error(io) naming the array
void require_same_parcels(const Archive& archive, const Strips& strips);

}  // namespace furrow::terrain::dem
