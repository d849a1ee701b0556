#include "terrain/dem/beds/bed_layers.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "protocol/core/assert.hpp"
#include "protocol/core/paced_call.hpp"

namespace furrow::terrain::dem {
namespace {

constexpr const char* kPlacing = "placing the grains";
constexpr std::size_t kCheckEvery = 1024;  // samples
constexpr int kTries = 30;  // candidates around a sample before it is retired [Bridson 2007]
constexpr double kDiskCoverage =
    0.491;  // share of the area covered by discs of the spacing's diameter, measured

class Uniform {
 public:
  explicit Uniform(std::uint64_t seed) : bits_(seed) {}
  double operator()() { return static_cast<double>(bits_() >> 11) * 0x1p-53; }  // [0, 1)

 private:
  std::mt19937_64 bits_;
};

}  // namespace

std::vector<Quad> poisson_layer(const Bin& bin, double radius, std::uint64_t seed,
                                const std::function<void()>& each) {
  FURROW_ASSERT(radius > 0.0 && bin.length > 2.0 * radius && bin.width > 2.0 * radius, radius, bin.length,
                bin.width);
  const double spacing = kSpacing * radius;
  const double length = bin.length - 2.0 * radius, width = bin.width - 2.0 * radius;
  const double cell = spacing / std::numbers::sqrt2;  // at most one sample per cell
  const auto nx = static_cast<std::int64_t>(length / cell) + 1,
             ny = static_cast<std::int64_t>(width / cell) + 1;
  std::vector<int> grid(static_cast<std::size_t>(nx * ny), -1);
  std::vector<Quad> samples;
  std::vector<int> active;
  Uniform uniform(seed);

  const auto cell_of = [&](double v, std::int64_t n) {
    return std::clamp<std::int64_t>(static_cast<std::int64_t>(v / cell), 0, n - 1);
  };
  const auto free = [&](double x, double y) {
    const std::int64_t cx = cell_of(x, nx), cy = cell_of(y, ny);
    for (std::int64_t ix = std::max<std::int64_t>(cx - 2, 0); ix <= std::min(cx + 2, nx - 1); ++ix)
      for (std::int64_t iy = std::max<std::int64_t>(cy - 2, 0); iy <= std::min(cy + 2, ny - 1); ++iy)
        if (const int s = grid[ix * ny + iy]; s >= 0) {
          const double dx = samples[s].x - x, dy = samples[s].y - y;
          if (dx * dx + dy * dy < spacing * spacing) return false;
        }
    return true;
  };
  const auto accept = [&](double x, double y) {
    grid[cell_of(x, nx) * ny + cell_of(y, ny)] = static_cast<int>(samples.size());
    active.push_back(static_cast<int>(samples.size()));
    samples.push_back({x, y, 0.0, 0.0});
  };

  const double first_x = length * uniform(), first_y = width * uniform();
  accept(first_x, first_y);
  while (!active.empty()) {
    if (each) each();
    const auto pick = static_cast<std::size_t>(uniform() * static_cast<double>(active.size()));
    const Quad from = samples[active[pick]];
    bool found = false;
    for (int k = 0; k < kTries && !found; ++k) {
      const double angle = 2.0 * std::numbers::pi * uniform();
      const double distance = spacing * (1.0 + uniform());
      const double x = from.x + distance * std::cos(angle), y = from.y + distance * std::sin(angle);
      if (x < 0.0 || x > length || y < 0.0 || y > width || !free(x, y)) continue;
      accept(x, y);
      found = true;
    }
    if (!found) {
      active[pick] = active.back();
      active.pop_back();
    }
  }
  for (Quad& s : samples) {
    s.x += radius;
    s.y += radius - 0.5 * bin.width;
  }
  return samples;
}

std::vector<Quad> bed_layers(const Bin& bin, double radius, int layers, std::uint64_t seed,
                             const ProgressCall& progress) {
  FURROW_ASSERT(layers >= 0, layers);
  std::vector<Quad> all;
  PacedCall tell(progress);
  for (int layer = 0; layer < layers; ++layer) {
    const double share = static_cast<double>(layer) / layers;
    tell(kPlacing, share);
    std::size_t samples_made = 0;
    std::vector<Quad> samples =
        poisson_layer(bin, radius, seed * 1000003ULL + static_cast<std::uint64_t>(layer), [&] {
          if (++samples_made % kCheckEvery == 0) tell(kPlacing, share);
        });
    for (Quad& s : samples) s.z = (layer + 0.5) * kSpacing * radius;
    all.insert(all.end(), samples.begin(), samples.end());
  }
  return all;
}

double expected_layer_count(const Bin& bin, double radius) {
  FURROW_ASSERT(radius > 0.0, radius);
  const double disc = 0.25 * std::numbers::pi * kSpacing * kSpacing * radius * radius;
  // Discs reach half a spacing beyond the samples' domain; half of that rim is gained.
  const double rim = (0.5 * kSpacing - 2.0) * radius;
  return kDiskCoverage * (bin.length + rim) * (bin.width + rim) / disc;
}

}  // namespace furrow::terrain::dem
