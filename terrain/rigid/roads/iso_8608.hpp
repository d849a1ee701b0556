// Roads of the classes of ISO 8608: random heights of a stated displacement power spectral density over the spatial
// frequency n (cycles/m),
//   G_d(n) = G_d(n_0) (n/n_0)⁻²,   n_0 = 0.1 1/m,   0.011 ≤ n ≤ 2.83 1/m,                                     (1)
// with the geometric mean of each class, G_d(n_0) = 16e-6 m³ for A and four times as much for each class after it.
// Heights are a sum of harmonics, one in each of `kHarmonics` bands of equal width in log n,
//   z(x) = Σ √(2 ∫_band G_d dn) cos(2π n_k x + φ_k),                                                           (2)
// n_k and φ_k random: the variance of every band is that of (1), for any seed.
//
// ISO 8608:2016, Mechanical vibration – Road surface profiles – Reporting of measured data, annex C, table C.1.
// M. Shinozuka, C.-M. Jan, Digital simulation of random processes and its applications,
// J. Sound Vib. 25 (1972) 111–128.
#pragma once

#include <cstdint>

#include "terrain/rigid/ground_profile.hpp"

namespace furrow::terrain {

inline constexpr int kRoadHarmonics = 512;
inline constexpr double kLeastRoadFrequency = 0.011, kMostRoadFrequency = 2.83;  // cycles/m
inline constexpr double kRoadSpacing = 0.05;  // of the points, m: a seventh of the shortest wave

/// G_d(n) of (1), m³. @param name 'A' to 'H'. @pre n > 0
double road_density(char name, double n);

/// Heights from x `from` over `length`, which begin and end at 0 with level tangent: they swell over 5 m, or a tenth of
/// the length where that is less.
/// @pre name is 'A' to 'H', length > 0
ProfilePoints iso_8608_road(char name, double from, double length, std::uint64_t seed);

}  // namespace furrow::terrain
