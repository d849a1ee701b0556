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
constexpr std::size_t kTellEvery = 1024;  // samples
constexpr int kTries = 30;                // candidates around a sample before it is retired [Bridson 2007]
constexpr double kDiskCoverage = 0.491;   // share of the area covered by discs of the spacing's diameter, measured

class Uniform {
 public:
  explicit Uniform(std::uint64_t seed) : bits_(seed) {}
  double operator()() { return static_cast<double>(bits_() >> 11) * 0x1p-53; }  // [0, 1)

 private:
  std::mt19937_64 bits_;
};

/// One side of the rectangle of samples, cut into cells with at most one sample each.
struct Side {
  double length = 0.0;  // m
  double cell = 0.0;    // m
  std::int64_t cells = 0;
  bool around = false;  // periodic: a sample that leaves at one end enters at the other

  Side(double length_, double most, bool around_) : length(length_), cell(most), around(around_) {
    cells = static_cast<std::int64_t>(length / cell) + 1;
    if (around) cell = length / static_cast<double>(cells);
  }
  std::int64_t cell_of(double v) const {
    return std::clamp<std::int64_t>(static_cast<std::int64_t>(v / cell), 0, cells - 1);
  }
  /// First and last cell that may contain a sample nearer than the spacing to one in cell `c`; for a periodic side they
  /// may be beyond its ends.
  std::pair<std::int64_t, std::int64_t> near(std::int64_t c) const {
    const std::int64_t from = c - 2, to = c + 2;
    return around ? std::pair(from, to) : std::pair(std::max<std::int64_t>(from, 0), std::min(to, cells - 1));
  }
  std::int64_t wrapped(std::int64_t c) const { return around ? (c + cells) % cells : c; }
  double shortest(double d) const { return around ? d - length * std::round(d / length) : d; }
  /// Moves a candidate into the rectangle if the side is periodic. Returns whether it is inside.
  bool take(double& v) const {
    if (around) v -= length * std::floor(v / length);
    return v >= 0.0 && v <= length;
  }
};

/// The samples of one layer, and the cell of each.
class Samples {
 public:
  Samples(const Side& x, const Side& y, double spacing)
      : x_(x), y_(y), spacing_(spacing), grid_(static_cast<std::size_t>(x.cells * y.cells), -1) {}

  std::vector<Quad>& points() { return points_; }

  bool free(double x, double y) const {
    const auto [x_from, x_to] = x_.near(x_.cell_of(x));
    const auto [y_from, y_to] = y_.near(y_.cell_of(y));
    for (std::int64_t ix = x_from; ix <= x_to; ++ix)
      for (std::int64_t iy = y_from; iy <= y_to; ++iy)
        if (const int s = grid_[x_.wrapped(ix) * y_.cells + y_.wrapped(iy)]; s >= 0) {
          const double dx = x_.shortest(points_[s].x - x), dy = y_.shortest(points_[s].y - y);
          if (dx * dx + dy * dy < spacing_ * spacing_) return false;
        }
    return true;
  }
  void accept(double x, double y) {
    grid_[x_.cell_of(x) * y_.cells + y_.cell_of(y)] = static_cast<int>(points_.size());
    points_.push_back({x, y, 0.0, 0.0});
  }

 private:
  Side x_, y_;
  double spacing_;
  std::vector<int> grid_;
  std::vector<Quad> points_;
};

/// Fills the rectangle with samples [Bridson 2007].
void sample(const Side& x_side, const Side& y_side, double spacing, std::uint64_t seed, Samples& samples,
            const std::function<void()>& each) {
  Uniform uniform(seed);
  const double first_x = x_side.length * uniform(), first_y = y_side.length * uniform();
  samples.accept(first_x, first_y);
  std::vector<int> active{0};
  while (!active.empty()) {
    if (each) each();
    const auto pick = static_cast<std::size_t>(uniform() * static_cast<double>(active.size()));
    const Quad from = samples.points()[active[pick]];
    bool found = false;
    for (int k = 0; k < kTries && !found; ++k) {
      const double angle = 2.0 * std::numbers::pi * uniform();
      const double distance = spacing * (1.0 + uniform());
      double x = from.x + distance * std::cos(angle), y = from.y + distance * std::sin(angle);
      if (!x_side.take(x) || !y_side.take(y) || !samples.free(x, y)) continue;
      active.push_back(static_cast<int>(samples.points().size()));
      samples.accept(x, y);
      found = true;
    }
    if (!found) {
      active[pick] = active.back();
      active.pop_back();
    }
  }
}

}  // namespace

std::vector<Quad> poisson_layer(const Bin& bin, double radius, std::uint64_t seed, const std::function<void()>& each,
                                bool around) {
  FURROW_ASSERT(radius > 0.0 && bin.length > 2.0 * radius && bin.width > 2.0 * radius, radius, bin.length, bin.width);
  const double spacing = kSpacing * radius;
  const double edge_x = around && bin.periodic_x ? 0.0 : radius, edge_y = around && bin.periodic_y ? 0.0 : radius;
  const double cell = spacing / std::numbers::sqrt2;  // at most one sample per cell
  const Side x(bin.length - 2.0 * edge_x, cell, around && bin.periodic_x),
      y(bin.width - 2.0 * edge_y, cell, around && bin.periodic_y);
  FURROW_ASSERT((!x.around || x.cells >= 5) && (!y.around || y.cells >= 5), x.cells, y.cells);
  Samples samples(x, y, spacing);
  sample(x, y, spacing, seed, samples, each);
  for (Quad& s : samples.points()) {
    s.x += edge_x;
    s.y += edge_y - 0.5 * bin.width;
  }
  return std::move(samples.points());
}

std::vector<Quad> bed_layers(const Bin& bin, double radius, int layers, std::uint64_t seed,
                             const ProgressCall& progress, bool around) {
  FURROW_ASSERT(layers >= 0, layers);
  std::vector<Quad> all;
  PacedCall tell(progress);
  for (int layer = 0; layer < layers; ++layer) {
    const double share = static_cast<double>(layer) / layers;
    tell(kPlacing, share);
    std::size_t samples_made = 0;
    const auto each = [&] {
      if (++samples_made % kTellEvery == 0) tell(kPlacing, share);
    };
    std::vector<Quad> samples =
        poisson_layer(bin, radius, seed * 1000003ULL + static_cast<std::uint64_t>(layer), each, around);
    for (Quad& s : samples) s.z = (layer + 0.5) * kSpacing * radius;
    all.insert(all.end(), samples.begin(), samples.end());
  }
  return all;
}

double expected_layer_count(const Bin& bin, double radius, bool around) {
  FURROW_ASSERT(radius > 0.0, radius);
  const double disc = 0.25 * std::numbers::pi * kSpacing * kSpacing * radius * radius;
  // Discs extend half a spacing beyond the samples' domain; half of that rim is gained.
  const auto side = [&](double length, bool periodic) {
    return around && periodic ? length : length + (0.5 * kSpacing - 2.0) * radius;
  };
  return kDiskCoverage * side(bin.length, bin.periodic_x) * side(bin.width, bin.periodic_y) / disc;
}

}  // namespace furrow::terrain::dem
