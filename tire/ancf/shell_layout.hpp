// Memory layout of a nodal field of the ring. Each (row, component) has one line with the columns side by side, so that
// neighbouring elements around the ring fill the lanes of a vector:
//   field[offset(j, c) + i],  j row across, c component (0–2 position, 3–5 director), i column
// Each line continues cyclically on both sides ("padding"), so that no index wraps in the inner loops.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "protocol/core/assert.hpp"
#include "protocol/core/simd.hpp"
#include "protocol/core/vec.hpp"

namespace furrow::tire {

using namespace simd;

using Field = std::vector<double>;

struct ShellLayout {
  int columns = 0;
  int rows = 0;

  int batches() const { return (columns + kDoubleLanes - 1) / kDoubleLanes; }
  int stride() const { return kDoubleLanes * (batches() + 2); }
  std::size_t offset(int j, int c) const {
    FURROW_ASSERT(in_range(j, rows) && in_range(c, 6), j, rows, c);
    return static_cast<std::size_t>(j * 6 + c) * stride() + kDoubleLanes;
  }
  std::size_t size() const { return static_cast<std::size_t>(rows) * 6 * stride(); }
  /// The rows between the beads are one contiguous block.
  std::size_t free_begin() const { return static_cast<std::size_t>(6) * stride(); }
  std::size_t free_size() const { return static_cast<std::size_t>(rows - 2) * 6 * stride(); }

  Vec3 get(const Field& f, int i, int j, int first) const {
    FURROW_ASSERT(in_range(i + kDoubleLanes, stride()) && (first == 0 || first == 3), i, columns, first);
    FURROW_ASSERT(f.size() == size(), f.size(), size());
    return Vec3(f[offset(j, first) + i], f[offset(j, first + 1) + i], f[offset(j, first + 2) + i]);
  }
  void set(Field& f, int i, int j, int first, const Vec3& v) const {
    FURROW_ASSERT(in_range(i + kDoubleLanes, stride()) && (first == 0 || first == 3), i, columns, first);
    FURROW_ASSERT(f.size() == size(), f.size(), size());
    for (int c = 0; c < 3; ++c) f[offset(j, first + c) + i] = v[c];
  }

  /// Continues every line cyclically.
  void fill_padding(Field& f) const {
    FURROW_ASSERT(f.size() == size() && columns >= kDoubleLanes, f.size(), size(), columns);
    const int right = stride() - kDoubleLanes - columns;
    for (int line = 0; line < rows * 6; ++line) {
      double* p = f.data() + static_cast<std::size_t>(line) * stride() + kDoubleLanes;
      std::copy(p + columns - kDoubleLanes, p + columns, p - kDoubleLanes);
      std::copy(p, p + right, p + columns);
    }
  }
  /// Adds the values beyond the last column to the first columns and clears the padding.
  void fold_padding(Field& f) const {
    FURROW_ASSERT(f.size() == size() && columns >= kDoubleLanes, f.size(), size(), columns);
    const int right = stride() - kDoubleLanes - columns;
    for (int line = 0; line < rows * 6; ++line) {
      double* p = f.data() + static_cast<std::size_t>(line) * stride() + kDoubleLanes;
      for (int k = 0; k < right; ++k) p[k] += p[columns + k];
      std::fill(p + columns, p + columns + right, 0.0);
      std::fill(p - kDoubleLanes, p, 0.0);
    }
  }
};

}  // namespace furrow::tire
