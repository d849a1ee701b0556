#include "terrain/rigid/roads/iso_8608.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "protocol/core/assert.hpp"

namespace furrow::terrain {
namespace {

constexpr double kReference = 0.1;  // n_0, cycles/m
constexpr double kClassA = 16e-6;   // G_d(n_0), m³
constexpr double kSwell = 5.0;      // m
constexpr double kTwoPi = 2.0 * std::numbers::pi;

/// Share of the road's heights at a distance from its nearer end; slope and curvature are continuous.
double swell(double distance, double over) {
  const double s = std::clamp(distance / over, 0.0, 1.0);
  return s * s * s * (10.0 - s * (15.0 - 6.0 * s));
}

/// A number in [0, 1) of 53 random bits: the same with every standard library.
double draw(std::mt19937_64& bits) { return static_cast<double>(bits() >> 11) * 0x1p-53; }

}  // namespace

double road_density(char name, double n) {
  FURROW_ASSERT(name >= 'A' && name <= 'H', name);
  FURROW_ASSERT(n > 0.0, n);
  return kClassA * std::pow(4.0, name - 'A') * (kReference / n) * (kReference / n);
}

ProfilePoints iso_8608_road(char name, double from, double length, std::uint64_t seed) {
  FURROW_ASSERT(length > 0.0, length);
  struct Harmonic {
    double amplitude, wave_number, phase;  // m, rad/m, rad
  };
  std::array<Harmonic, kRoadHarmonics> harmonics;
  std::mt19937_64 bits(seed);
  const double ratio = std::pow(kMostRoadFrequency / kLeastRoadFrequency, 1.0 / kRoadHarmonics);
  double low = kLeastRoadFrequency;
  for (Harmonic& h : harmonics) {
    const double high = low * ratio;
    const double variance = road_density(name, kReference) * kReference * kReference * (1.0 / low - 1.0 / high);
    h.amplitude = std::sqrt(2.0 * variance);
    h.wave_number = kTwoPi * low * std::pow(ratio, draw(bits));
    h.phase = kTwoPi * draw(bits);
    low = high;
  }
  const int intervals = std::max(2, static_cast<int>(std::ceil(length / kRoadSpacing)));
  const double over = std::min(kSwell, 0.1 * length);
  ProfilePoints points;
  points.reserve(intervals + 1);
  for (int k = 0; k <= intervals; ++k) {
    const double s = length * k / intervals;
    double z = 0.0;
    for (const Harmonic& h : harmonics) z += h.amplitude * std::cos(h.wave_number * s + h.phase);
    points.push_back({from + s, z * swell(std::min(s, length - s), over)});
  }
  return points;
}

}  // namespace furrow::terrain
