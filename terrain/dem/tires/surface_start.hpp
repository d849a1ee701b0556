// Requirements of grains on a tire's surface before the first step.
#pragma once

#include "protocol/core/surface.hpp"
#include "terrain/dem/bin.hpp"
#include "terrain/dem/dem_options.hpp"

namespace furrow::terrain::dem {

/// @param index of the tire, for messages
/// @throws Error(bad_input) when the law cannot use the material, or the surface starts beyond a side of the bin
void check_surface_start(const DemOptions& options, const Bin& bin, const ContactMaterial& material,
                         const SurfaceState& start, int index);

}  // namespace furrow::terrain::dem
