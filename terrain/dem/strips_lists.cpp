// The lists of a strip: its pairs, and its grains near walls.
#include <algorithm>

#include "protocol/core/assert.hpp"
#include "terrain/dem/near_four.hpp"
#include "terrain/dem/strips.hpp"

namespace furrow::terrain::dem {
namespace {

/// Pairs in the order in which they are found; memory is reused from call to call.
struct FoundPairs {
  std::vector<std::uint32_t> i, j;
  std::size_t count = 0;

  void make_room(std::size_t more) {
    if (count + more <= i.size()) return;
    i.resize(2 * (count + more));
    j.resize(2 * (count + more));
  }
};

}  // namespace

void Strips::list_pairs(const Grains& grains, int k) {
  FURROW_ASSERT(in_range(k, count()), k, count());
  FURROW_ASSERT(strips_[k].cell_start.size() == static_cast<std::size_t>(ny_ * nz_ + 1), k,
                strips_[k].cell_start.size(), ny_, nz_);
  Strip& strip = strips_[k];
  const int after = next(k);
  const Strip* const beside = after < 0 ? nullptr : &strips_[after];
  const double width = options_.bin.periodic_y ? options_.bin.width : 0.0;
  static thread_local FoundPairs found;
  found.count = 0;

  // Lists (i, j) for the grains j in [from, to) of `other`, whose numbering in this strip starts at `base`.
  const auto scan = [&](int i, Double4 at, const Strip& other, int base, int from, int to) {
    found.make_room(to - from + 4);
    const Quad* const x = grains.position.data() + other.first;
    for (int j = from; j < to; j += 4) {
      const unsigned hit = near_four(x + j, to - j, at, options_.skin, width);
      for (int m = 0; m < 4; ++m) {  // without a branch, because the outcome cannot be predicted
        found.i[found.count] = kQuad * i;
        found.j[found.count] = kQuad * (base + j + m);
        found.count += hit >> m & 1;
      }
    }
  };
  for (int y = 0; y < ny_; ++y)
    for (int z = 0; z < nz_; ++z) {
      const int cell = y * nz_ + z;
      const int below = std::max(z - 1, 0), above = std::min(z + 1, nz_ - 1) + 1;
      for (int i = strip.cell_start[cell]; i < strip.cell_start[cell + 1]; ++i) {
        const Double4 at = load(grains.position[strip.first + i]);
        const auto row = [&](const Strip& other, int base, Double4 from, int wanted) {
          int other_y = wanted;
          if (width > 0.0) {
            other_y = (wanted + ny_) % ny_;
          } else if (wanted < 0 || wanted >= ny_) {
            return;
          }
          scan(i, from, other, base, other.cell_start[other_y * nz_ + below], other.cell_start[other_y * nz_ + above]);
        };
        scan(i, at, strip, 0, i + 1, strip.cell_start[y * nz_ + above]);
        row(strip, 0, at, y + 1);
        if (!beside) continue;
        // For grains of the first strip, the last strip appears one length before them.
        Double4 seen = at;
        if (after < k) seen[0] -= options_.bin.length;
        for (int dy = -1; dy <= 1; ++dy) row(*beside, strip.grains(), seen, y + dy);
      }
    }
  const auto n = static_cast<std::ptrdiff_t>(found.count);
  strip.i.assign(found.i.begin(), found.i.begin() + n);
  strip.j.assign(found.j.begin(), found.j.begin() + n);
  size_lists(strip, static_cast<int>(n));
}

void Strips::list_walls(const Grains& grains, Strip& strip) const {
  FURROW_ASSERT(strip.first >= 0 && strip.first <= strip.last && strip.last <= grains.count, strip.first, strip.last,
                grains.count);
  strip.walls.clear();
  strip.x_min = 1e300, strip.x_max = strip.z_max = -1e300;
  for (int g = strip.last - 1; g >= strip.first; --g)
    if (!options_.bin.holds(grains.position[g])) strip.lost = g - strip.first;
  for (int g = strip.first; g < strip.last; ++g) {
    strip.x_min = std::min(strip.x_min, grains.position[g].x);
    strip.x_max = std::max(strip.x_max, grains.position[g].x);
    strip.z_max = std::max(strip.z_max, grains.position[g].z);
    for (int wall = 0; wall < kWalls; ++wall)
      if (options_.bin.has_wall(wall) &&
          options_.bin.distance(wall, grains.position[g]) < grains.position[g].w + options_.skin)
        strip.walls.push_back({g - strip.first, wall, {}, {}});
  }
}

}  // namespace furrow::terrain::dem
