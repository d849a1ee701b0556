// Pairs of points nearer than a distance, found from positions alone: for statistics and checks, not for stepping.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "protocol/core/assert.hpp"
#include "protocol/core/paced_call.hpp"
#include "terrain/dem/bin.hpp"
#include "terrain/dem/quad.hpp"

namespace furrow::terrain::dem {

/// Shortest vector from a to b in a bin that may be periodic, m.
inline Quad shortest(const Bin& bin, const Quad& a, const Quad& b) {
  Quad d{b.x - a.x, b.y - a.y, b.z - a.z, 0.0};
  if (bin.periodic_x) d.x -= bin.length * std::round(d.x / bin.length);
  if (bin.periodic_y) d.y -= bin.width * std::round(d.y / bin.width);
  return d;
}

/// Calls f(a, b, distance) with a < b once for each pair nearer than `reach`, in ascending a, then b. May throw what
/// `progress` throws.
/// @pre all points lie in the bin, and a periodic side is at least two reaches long.
template <class F>
void for_close_pairs(const std::vector<Quad>& points, const Bin& bin, double reach, F&& f,
                     const ProgressCall& progress = {}) {
  FURROW_ASSERT(reach > 0.0 && std::isfinite(reach), reach);
  FURROW_ASSERT(!bin.periodic_x || bin.length >= 2.0 * reach, bin.length, reach);
  FURROW_ASSERT(!bin.periodic_y || bin.width >= 2.0 * reach, bin.width, reach);
  FURROW_ASSERT(std::all_of(points.begin(), points.end(), [&](const Quad& p) { return bin.holds(p); }), points.size());
  struct Cell {
    std::int64_t x, y, z;
  };
  double top = 0.0;
  for (const Quad& p : points) top = std::max(top, p.z);
  const auto cells = [&](double size) {
    return std::clamp<std::int64_t>(static_cast<std::int64_t>(size / reach), 1, 4096);
  };
  const std::int64_t nx = cells(bin.length), ny = cells(bin.width), nz = std::min<std::int64_t>(cells(top), 256);
  const auto at = [](double v, double size, std::int64_t n) {
    return std::clamp<std::int64_t>(static_cast<std::int64_t>(v / size * static_cast<double>(n)), 0, n - 1);
  };
  const auto cell_of = [&](const Quad& p) {
    return Cell{at(p.x, bin.length, nx), at(p.y + 0.5 * bin.width, bin.width, ny), top > 0.0 ? at(p.z, top, nz) : 0};
  };
  const auto index = [&](const Cell& c) { return (c.x * ny + c.y) * nz + c.z; };
  std::vector<std::int64_t> start(static_cast<std::size_t>(nx * ny * nz) + 1, 0), order(points.size());
  for (const Quad& p : points) ++start[index(cell_of(p)) + 1];
  for (std::size_t k = 1; k < start.size(); ++k) start[k] += start[k - 1];
  std::vector<std::int64_t> next(start.begin(), start.end() - 1);
  for (std::size_t g = 0; g < points.size(); ++g) order[next[index(cell_of(points[g]))]++] = g;

  /// Neighbouring cells along one side, each of them once.
  const auto around = [](std::int64_t c, std::int64_t n, bool periodic, std::int64_t(&out)[3]) {
    int count = 0;
    for (std::int64_t k = c - 1; k <= c + 1; ++k) {
      if (!periodic && (k < 0 || k >= n)) continue;
      const std::int64_t wrapped = (k + n) % n;
      if (std::find(out, out + count, wrapped) == out + count) out[count++] = wrapped;
    }
    return count;
  };
  std::vector<std::int64_t> near;
  PacedCall tell(progress);
  for (std::size_t a = 0; a < points.size(); ++a) {
    if (a % 1024 == 0) tell("comparing grains", static_cast<double>(a) / static_cast<double>(points.size()));
    const Cell c = cell_of(points[a]);
    std::int64_t xs[3], ys[3], zs[3];
    const int cx = around(c.x, nx, bin.periodic_x, xs), cy = around(c.y, ny, bin.periodic_y, ys),
              cz = around(c.z, nz, false, zs);
    near.clear();
    for (int i = 0; i < cx; ++i)
      for (int j = 0; j < cy; ++j)
        for (int k = 0; k < cz; ++k) {
          const std::int64_t cell = index({xs[i], ys[j], zs[k]});
          for (std::int64_t q = start[cell]; q < start[cell + 1]; ++q)
            if (order[q] > static_cast<std::int64_t>(a)) near.push_back(order[q]);
        }
    std::sort(near.begin(), near.end());
    for (const std::int64_t b : near) {
      const Quad d = shortest(bin, points[a], points[b]);
      const double square = d.x * d.x + d.y * d.y + d.z * d.z;
      if (square < reach * reach) f(a, static_cast<std::size_t>(b), std::sqrt(square));
    }
  }
}

}  // namespace furrow::terrain::dem
