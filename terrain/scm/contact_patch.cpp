#include "terrain/scm/contact_patch.hpp"

#include <algorithm>
#include <cmath>

#include "protocol/core/assert.hpp"

namespace furrow::terrain::scm {
namespace {

/// Twice the area of the triangle (a, b, c), positive where it runs counter-clockwise.
long turn(const Cell& a, const Cell& b, const Cell& c) {
  return static_cast<long>(b[0] - a[0]) * (c[1] - a[1]) - static_cast<long>(b[1] - a[1]) * (c[0] - a[0]);
}

/// Convex hull by Andrew's monotone chain, counter-clockwise.
std::vector<Cell> convex_hull(std::vector<Cell> points) {
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  std::vector<Cell> hull;
  const auto chain = [&](auto from, auto to) {
    const std::size_t base = hull.size();
    for (auto p = from; p != to; ++p) {
      while (hull.size() >= base + 2 && turn(hull[hull.size() - 2], hull.back(), *p) <= 0) hull.pop_back();
      hull.push_back(*p);
    }
    hull.pop_back();  // begins the other chain
  };
  chain(points.begin(), points.end());
  chain(points.rbegin(), points.rend());
  return hull;
}

/// Root of a cell's set, with path halving.
int root_of(std::vector<int>& parent, int k) {
  while (parent[k] != k) k = parent[k] = parent[parent[k]];
  return k;
}

}  // namespace

double patch_width(std::span<const Cell> cells, double spacing) {
  FURROW_ASSERT(!cells.empty() && spacing > 0.0, cells.size(), spacing);
  std::vector<Cell> corners;
  corners.reserve(4 * cells.size());
  for (const Cell& c : cells)
    for (const int i : {0, 1})
      for (const int j : {0, 1}) corners.push_back({c[0] + i, c[1] + j});
  const std::vector<Cell> hull = convex_hull(std::move(corners));
  double twice_area = 0.0, perimeter = 0.0;
  for (std::size_t k = 0; k < hull.size(); ++k) {
    const Cell &a = hull[k], &b = hull[(k + 1) % hull.size()];
    twice_area += static_cast<double>(static_cast<long>(a[0]) * b[1] - static_cast<long>(a[1]) * b[0]);
    perimeter += std::hypot(b[0] - a[0], b[1] - a[1]);
  }
  return spacing * twice_area / perimeter;
}

std::vector<int> patches(std::span<const Cell> cells) {
  std::vector<int> parent(cells.size());
  for (std::size_t k = 0; k < cells.size(); ++k) parent[k] = static_cast<int>(k);
  for (std::size_t k = 0; k < cells.size(); ++k)
    for (const Cell& step : {Cell{-1, -1}, Cell{-1, 0}, Cell{-1, 1}, Cell{0, -1}}) {
      const Cell other{cells[k][0] + step[0], cells[k][1] + step[1]};
      const auto found = std::lower_bound(cells.begin(), cells.begin() + k, other);
      if (found == cells.begin() + k || *found != other) continue;
      const int a = root_of(parent, static_cast<int>(k)),
                b = root_of(parent, static_cast<int>(found - cells.begin()));
      parent[std::max(a, b)] = std::min(a, b);
    }
  std::vector<int> number(cells.size(), -1);
  int count = 0;
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const int root = root_of(parent, static_cast<int>(k));  // the first cell of its patch
    number[k] = root == static_cast<int>(k) ? count++ : number[root];
  }
  return number;
}

}  // namespace furrow::terrain::scm
