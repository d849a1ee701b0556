// A large bed, assembled from copies of a settled piece (`terrain.tile`).
//
// The piece settles with periodic images at its ends, and at its sides too if several are side by side; a piece as wide
// as the bin has the bin's sides. Adjacent copies along y are one packing. Along x, the direction of travel, columns of
// them follow one another. Plain repeated copies would need no seams, but means over a wheel's path would be those of
// one piece, repeated. So every other column is turned by half a turn about the vertical, and every other pair of
// columns is mirrored. If the sides of a piece are periodic, each column is also moved across by another share of its
// width (multiples of the golden ratio). Then a wheel meets other soil in each column, and left and right wheels meet
// different soil. Between walls there is no space for this: a wheel in the middle meets its strip of the piece again,
// from ahead or from behind, mirrored or not.
//
// The price is seams between columns, where two packings do not fit. There both extend kSeamBand radii into each other,
// and most_compatible() decides which grains stay; these overlap no more than grains of the piece do. At walls that the
// piece does not have, grains that would be in the wall are left out. The whole bed then settles again from these
// positions with new contacts, which closes the remaining gaps.
#pragma once

#include <vector>

#include "protocol/core/progress_call.hpp"
#include "terrain/dem/bin.hpp"
#include "terrain/dem/dem_options.hpp"
#include "terrain/dem/quad.hpp"

namespace furrow::terrain::dem {

/// The bin of a bed.
Bin bin_of(const DemOptions& options);

inline constexpr double kSeamBand = 10.0;    // largest radii by which packings overlap on either side
inline constexpr double kLeastPiece = 40.0;  // least side of a piece in largest radii

struct Tiling {
  int along = 1, across = 1;
  double length = 0.0, width = 0.0;  // of a piece, m
};

/// Pieces as nearly `tile` long and wide as the bin allows; one piece, the bin, if no bed is generated or `tile` is 0.
Tiling tiling_of(const DemOptions& options);

/// Whether the bed is assembled from more than one piece.
bool is_tiled(const DemOptions& options);

DemOptions piece_of(const DemOptions& options);

/// Positions of a bed from the positions of a settled piece, both with radii; column by column.
/// May throw what `progress` throws.
/// @pre is_tiled(options); the piece's grains are between its sides
std::vector<Quad> tiled_positions(const std::vector<Quad>& piece, const DemOptions& options,
                                  const ProgressCall& progress = {});

/// Expected number of grains of a bed whose piece has that many.
double expected_tiled_grains(const DemOptions& options, double piece);

/// @throws Error(bad_input) when the pieces would be too small
void check_tiling(const DemOptions& options);

}  // namespace furrow::terrain::dem
