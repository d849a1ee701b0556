#include "terrain/dem/grain_sizes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "terrain/dem/contact/laws.hpp"

namespace furrow::terrain::dem {
namespace {

constexpr double kCut = 2.0;  // normal distribution: spread in standard deviations; nothing is drawn beyond it

/// Variance of the radius, relative to the square of the whole spread.
double relative_variance(const DemOptions& o) {
  if (o.size_distribution == "uniform") return 1.0 / 3.0;
  // Normal distribution cut at ± kCut [Johnson, Kotz & Balakrishnan 1994, Continuous univariate distributions 1,
  // §10.1].
  const double density = std::exp(-0.5 * kCut * kCut) / std::sqrt(2.0 * std::numbers::pi);
  return (1.0 - 2.0 * kCut * density / std::erf(kCut / std::numbers::sqrt2)) / (kCut * kCut);
}

class Draw {
 public:
  Draw(const DemOptions& o, std::uint64_t seed) : bits_(seed), normal_(o.size_distribution == "normal") {}
  /// A random number in [−1, 1).
  double operator()() {
    for (;;) {
      const double x = 2.0 * uniform() - 1.0;
      if (!normal_ || uniform() < std::exp(-0.5 * kCut * kCut * x * x)) return x;
    }
  }

 private:
  double uniform() { return static_cast<double>(bits_() >> 11) * 0x1p-53; }
  std::mt19937_64 bits_;
  bool normal_;
};

}  // namespace

void check_sizes(const DemOptions& o) {
  if (o.size_spread > 0.0 && !has_sizes(law_from(o.law))) {
    std::string expected;
    for_each_law([&](auto law) { expected += law.kSizes ? fmt::format("law '{}' or ", law.kName) : ""; });
    throw input_error(o.scenario, "terrain.size_spread",
                      fmt::format("is {} with law '{}', whose stiffness is stated for one size, expected {}0",
                                  o.size_spread, o.law, expected));
  }
}

double smallest_radius(const DemOptions& o) { return o.radius * (1.0 - o.size_spread); }
double largest_radius(const DemOptions& o) { return o.radius * (1.0 + o.size_spread); }

DemOptions of_one_size(DemOptions options, double radius) {
  FURROW_ASSERT(radius > 0.0, radius);
  options.radius = radius;
  options.size_spread = 0.0;
  return options;
}

// Both distributions are symmetric, so the mean of (1 + s x)³ is 1 + 3 s² var(x).
double mean_volume_ratio(const DemOptions& o) {
  FURROW_ASSERT(o.size_spread >= 0.0 && o.size_spread < 1.0, o.size_spread);
  return 1.0 + 3.0 * o.size_spread * o.size_spread * relative_variance(o);
}

double median_radius_by_mass(const DemOptions& o) {
  FURROW_ASSERT(o.size_spread >= 0.0 && o.size_spread < 1.0, o.size_spread);
  constexpr int kParts = 2000;
  const auto radius = [&](double part) { return o.radius * (1.0 + o.size_spread * (2.0 * part / kParts - 1.0)); };
  std::vector<double> until{0.0};  // mass of the grains below the end of each part of the spread, in any unit
  for (int k = 0; k < kParts; ++k) {
    const double x = (2.0 * k + 1.0) / kParts - 1.0;
    const double share = o.size_distribution == "uniform" ? 1.0 : std::exp(-0.5 * kCut * kCut * x * x);
    until.push_back(until.back() + share * std::pow(radius(k + 0.5), 3));
  }
  const double half = 0.5 * until.back();
  const auto above = std::upper_bound(until.begin(), until.end(), half);
  return radius(static_cast<double>(above - until.begin()) - (*above - half) / (*above - *(above - 1)));
}

void draw_radii(const DemOptions& o, std::vector<Quad>& grains) {
  FURROW_ASSERT(o.radius > 0.0 && o.size_spread >= 0.0 && o.size_spread < 1.0, o.radius, o.size_spread);
  Draw draw(o, o.seed * 1000003ULL + 0x9e3779b9ULL);
  for (Quad& p : grains) p.w = o.size_spread > 0.0 ? o.radius * (1.0 + o.size_spread * draw()) : o.radius;
}

}  // namespace furrow::terrain::dem
