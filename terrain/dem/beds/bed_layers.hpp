// Initial positions of the grains of a new bed: layers of Poisson-disk samples, one above the other.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "terrain/dem/bin.hpp"
#include "terrain/dem/quad.hpp"
#include "terrain/terrain.hpp"

namespace furrow::terrain::dem {

/// Spacing of samples and of layers, in grain radii; grains of neighbouring layers never touch.
inline constexpr double kSpacing = 2.02;

/// Points of one layer, no two nearer than kSpacing · radius, each at least a radius from the bin's walls
/// [Bridson 2007, Fast Poisson disk sampling in arbitrary dimensions, doi:10.1145/1278780.1278807]. z = 0.
/// `each` is called for every sample and may throw to stop. `around`: samples keep their distance across periodic sides
/// of the bin and need no distance from these sides, so that adjacent copies of the layer form one layer.
/// @pre 0 < 2 radius < length and width of the bin; `around`: 8 radii or more
std::vector<Quad> poisson_layer(const Bin& bin, double radius, std::uint64_t seed,
                                const std::function<void()>& each = {}, bool around = false);

/// All layers; the lowest one is half a spacing above the floor. Each layer has its own samples.
std::vector<Quad> bed_layers(const Bin& bin, double radius, int layers, std::uint64_t seed,
                             const ProgressCall& progress = {}, bool around = false);

/// Expected number of samples per layer, from the density that poisson_layer reaches.
double expected_layer_count(const Bin& bin, double radius, bool around = false);

}  // namespace furrow::terrain::dem
