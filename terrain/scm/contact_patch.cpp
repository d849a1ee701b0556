#include "terrain/scm/contact_patch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "protocol/core/assert.hpp"

namespace furrow::terrain::scm {
namespace {

/// Twice the area of the triangle (a, b, c), positive where it runs counter-clockwise.
long turn(const Cell& a, const Cell& b, const Cell& c) {
  return static_cast<long>(b[0] - a[0]) * (c[1] - a[1]) - static_cast<long>(b[1] - a[1]) * (c[0] - a[0]);
}

}  // namespace

void PatchFinder::find(std::span<const Cell> cells) {
  find_runs(cells);
  join_runs();
  number_.clear(), rows_.clear();
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    const int root = root_of(static_cast<int>(r));  // the first run of its patch
    if (root == static_cast<int>(r)) {
      number_.push_back(count());
      rows_.push_back({runs_[r].row, runs_[r].row, 0});
    } else {
      number_.push_back(number_[root]);
    }
    rows_[number_[r]].end = runs_[r].row + 1;
  }
  patch_.resize(cells.size());
  for (std::size_t r = 0; r < runs_.size(); ++r)
    std::fill_n(patch_.begin() + runs_[r].first, runs_[r].end - runs_[r].begin, number_[r]);
  find_ends();
}

void PatchFinder::find_runs(std::span<const Cell> cells) {
  runs_.clear();
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const auto [i, j] = cells[k];
    FURROW_ASSERT(k == 0 || cells[k - 1] < cells[k], i, j);
    if (!runs_.empty() && runs_.back().row == i && runs_.back().end == j) {
      ++runs_.back().end;
    } else {
      const int at = static_cast<int>(runs_.size());
      runs_.push_back({i, j, j + 1, static_cast<int>(k), at});
    }
  }
}

/// Runs of neighbouring rows touch where their cells do, at corners too.
void PatchFinder::join_runs() {
  std::size_t before = 0;
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    const Run& run = runs_[r];
    while (runs_[before].row < run.row - 1 || (runs_[before].row == run.row - 1 && runs_[before].end < run.begin))
      ++before;
    for (std::size_t b = before; runs_[b].row == run.row - 1 && runs_[b].begin <= run.end; ++b) {
      const int one = root_of(static_cast<int>(b)), other = root_of(static_cast<int>(r));
      runs_[std::max(one, other)].parent = std::min(one, other);
    }
  }
}

/// With path halving.
int PatchFinder::root_of(int run) {
  while (runs_[run].parent != run) run = runs_[run].parent = runs_[runs_[run].parent].parent;
  return run;
}

void PatchFinder::find_ends() {
  int total = 0;
  for (Rows& rows : rows_) rows.first = total, total += rows.end - rows.begin;
  low_.assign(total, std::numeric_limits<int>::max());
  high_.assign(total, std::numeric_limits<int>::min());
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    const Rows& rows = rows_[number_[r]];
    const int at = rows.first + runs_[r].row - rows.begin;
    low_[at] = std::min(low_[at], runs_[r].begin);
    high_[at] = std::max(high_[at], runs_[r].end);
  }
}

/// One side of a convex hull by Andrew's monotone chain; its last point begins the other side.
void PatchFinder::chain(std::span<const Cell> points) {
  const std::size_t base = hull_.size();
  for (const Cell& p : points) {
    while (hull_.size() >= base + 2 && turn(hull_[hull_.size() - 2], hull_.back(), p) <= 0) hull_.pop_back();
    hull_.push_back(p);
  }
  hull_.pop_back();
}

/// Of all corners of cells only those at the ends of rows can be on the hull.
double PatchFinder::width(int patch, double spacing) {
  FURROW_ASSERT(patch >= 0 && patch < count() && spacing > 0.0, patch, count(), spacing);
  const Rows& rows = rows_[patch];
  const int last = rows.first + rows.end - rows.begin - 1;
  corners_.clear(), hull_.clear();
  for (int i = rows.begin; i <= rows.end; ++i) {
    const int above = std::min(rows.first + i - rows.begin, last),
              below = std::max(rows.first + i - rows.begin - 1, rows.first);
    corners_.push_back({i, std::min(low_[below], low_[above])});
    corners_.push_back({i, std::max(high_[below], high_[above])});
  }
  chain(corners_);
  std::reverse(corners_.begin(), corners_.end());
  chain(corners_);
  double twice_area = 0.0, perimeter = 0.0;
  for (std::size_t k = 0; k < hull_.size(); ++k) {
    const Cell &a = hull_[k], &b = hull_[(k + 1) % hull_.size()];
    twice_area += static_cast<double>(static_cast<long>(a[0]) * b[1] - static_cast<long>(a[1]) * b[0]);
    perimeter += std::hypot(b[0] - a[0], b[1] - a[1]);
  }
  return spacing * twice_area / perimeter;
}

}  // namespace furrow::terrain::scm
