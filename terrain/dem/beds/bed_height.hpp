// Height of the grains: mean over cells of 2r of the highest grain top.
#pragma once

#include "protocol/core/surface.hpp"
#include "protocol/core/terrain_state.hpp"
#include "terrain/dem/bin.hpp"
#include "terrain/dem/grains.hpp"

namespace furrow::terrain::dem {

/// Highest grain top per cell; NaN in a cell without a grain's centre. @pre cell > 0
HeightField bed_height_field(const Grains& grains, const Bin& bin, double cell);

/// Mean of the cells whose centres are in the rectangle and that contain a grain; 0, the floor, when there are none.
double mean_height(const HeightField& field, double x_min, double x_max, double y_min, double y_max);

/// Highest point of grains that extend into the rectangle; 0 when there are none, m. @pre x_min ≤ x_max, y_min ≤ y_max
double top_height(const Grains& grains, double x_min, double x_max, double y_min, double y_max);

}  // namespace furrow::terrain::dem
