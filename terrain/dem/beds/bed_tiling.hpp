// A large bed put together of copies of a settled piece (`terrain.tile`).
//
// The piece is settled with periodic images at its ends, and at its sides too where several stand beside each other;
// one that fills the width of the bin has the bin's sides. Copies beside each other along y are one packing. Along x,
// the way that wheels go, columns of them stand one after the other. Copies that are simply repeated would need no
// seams, but means over a wheel's way would be those of one piece, met again and again. So every other column is turned
// by half a turn about the vertical, every other pair of them mirrored, and where the sides of a piece are periodic
// each is moved across by another share of its width (multiples of the golden ratio): then a wheel meets other soil in
// each column, and left and right wheels do not meet the same. Between walls there is no room for that, and a wheel in
// the middle meets its strip of the piece again, from ahead or from behind, mirrored or not.
//
// What this costs are seams between columns, where two packings do not fit. There both are taken to reach kSeamBand
// radii into each other, and most_compatible() says which grains stay: those that stay overlap no more than grains of
// the piece do. At walls which the piece has not met grains that would be in the wall are left out. The whole then
// settles once more, from these positions with new contacts, which closes what gaps there are.
#pragma once

#include <vector>

#include "protocol/core/progress_call.hpp"
#include "terrain/dem/dem_options.hpp"
#include "terrain/dem/quad.hpp"

namespace furrow::terrain::dem {

inline constexpr double kSeamBand = 10.0;    // largest radii that packings reach into each other, on either side
inline constexpr double kLeastPiece = 40.0;  // sides of a piece in largest radii

/// Pieces along the bin and across it.
struct Tiling {
  int along = 1, across = 1;
  double length = 0.0, width = 0.0;  // of a piece, m
};

/// Pieces as nearly `tile` long and wide as the bin's sides allow; one, the bin, where no
/// bed is generated or `tile` is 0.
Tiling tiling_of(const DemOptions& options);

/// Whether the bed is put together of more than one piece.
bool is_tiled(const DemOptions& options);

/// The bed that a piece is.
DemOptions piece_of(const DemOptions& options);

/// Positions of a bed from those of a settled piece, both with radii; column by column.
/// May throw what `progress` throws.
/// @pre is_tiled(options); the piece's grains stand between its sides
std::vector<Quad> tiled_positions(const std::vector<Quad>& piece, const DemOptions& options,
                                  const ProgressCall& progress = {});

/// Grains to be expected of a bed whose piece has that many.
double expected_tiled_grains(const DemOptions& options, double piece);

/// @throws Error(bad_input) when the pieces would be too small
void check_tiling(const DemOptions& options);

}  // namespace furrow::terrain::dem
