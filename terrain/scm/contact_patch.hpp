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

/// 2 A/P of the convex hull of these cells, m. @pre there is one or more
double patch_width(std::span<const Cell> cells, double spacing);

/// Divides cells into patches: for each of them the number of its patch, from 0, in order of the first cell of each.
/// @pre cells in ascending order, no two alike
std::vector<int> patches(std::span<const Cell> cells);

}  // namespace furrow::terrain::scm
