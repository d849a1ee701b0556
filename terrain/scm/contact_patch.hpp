// The width b of Bekker's law, from the patches in which a surface touches the grid.
//
// b is the smaller side of a long plate or the radius of a disc [Bekker 1969; Wong 2008, §2.4: both give the same
// parameters]. b = 2 A/P, A area and P perimeter of a patch, is either: (w l)·2/(2 (w + l)) → w for l ≫ w, and r for a
// disc (as Chrono's SCM has it). Of a compact patch it is less than the smaller side, of a square half of it. A patch
// is a connected set of cells, neighbours at corners among them; area and perimeter are those of the convex hull of its
// cells, which has no stairs.
#pragma once

#include <array>
#include <span>
#include <vector>

namespace furrow::terrain::scm {

using Cell = std::array<int, 2>;  // along x, along y

/// Keeps its buffers from one set of cells to the next.
class PatchFinder {
 public:
  /// Divides cells into patches. @pre cells in ascending order, no two alike
  void find(std::span<const Cell> cells);

  /// For each cell the number of its patch, from 0, in order of the first cell of each.
  const std::vector<int>& patch() const { return patch_; }
  int count() const { return static_cast<int>(rows_.size()); }
  /// 2 A/P of the convex hull of a patch, m. @param spacing of the cells, m
  double width(int patch, double spacing);

 private:
  /// Neighbouring cells of one row.
  struct Run {
    int row, begin, end;  // along x; along y, `end` not included
    int first;            // its place in the cells
    int parent;           // a run of the same patch, not behind it
  };
  /// The rows of a patch, and where their ends stand in `low_` and `high_`.
  struct Rows {
    int begin, end, first;
  };

  void find_runs(std::span<const Cell> cells);
  void join_runs();
  int root_of(int run);
  void find_ends();
  void chain(std::span<const Cell> points);

  std::vector<Run> runs_;
  std::vector<int> number_;  // of the patch of each run
  std::vector<int> patch_;
  std::vector<Rows> rows_;            // of each patch
  std::vector<int> low_, high_;       // of each row: its first cell along y, and the one behind its last
  std::vector<Cell> corners_, hull_;  // of the patch at hand
};

}  // namespace furrow::terrain::scm
