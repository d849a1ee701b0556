#include "tire/ancf/shell_factor.hpp"

#include <cholmod.h>

#include <algorithm>
#include <set>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"

namespace furrow::tire {
namespace {
constexpr int kColumn[4] = {0, 1, 1, 0}, kRow[4] = {0, 0, 1, 1};
// Blocks of a node with itself and with its neighbours, by their distances.
constexpr int kKinds = 5;
constexpr int kKindColumn[kKinds] = {0, 0, 1, 1, 1}, kKindRow[kKinds] = {0, 1, -1, 0, 1};

/// Fill-reducing order and supernodes of a pattern by CHOLMOD and METIS.
/// @param columns  of the lower triangle, rows ascending
PanelPattern analyze(const std::vector<std::vector<int>>& columns, std::vector<int>& place) {
  cholmod_common common;
  cholmod_start(&common);
  common.supernodal = CHOLMOD_SUPERNODAL;
  common.nmethods = 1;
  common.method[0].ordering = CHOLMOD_METIS;
  common.postorder = 1;
  common.print = 0;
  const std::size_t n = columns.size();
  std::size_t entries = 0;
  for (const auto& column : columns) entries += column.size();
  cholmod_sparse* matrix = cholmod_allocate_sparse(n, n, entries, 1, 1, -1, CHOLMOD_PATTERN, &common);
  cholmod_factor* factor = nullptr;
  if (matrix) {
    auto* start = static_cast<int*>(matrix->p);
    auto* row = static_cast<int*>(matrix->i);
    start[0] = 0;
    for (std::size_t c = 0; c < n; ++c) {
      row = std::copy(columns[c].begin(), columns[c].end(), row);
      start[c + 1] = start[c] + static_cast<int>(columns[c].size());
    }
    factor = cholmod_analyze(matrix, &common);
  }
  PanelPattern pattern;
  if (factor) {
    pattern = PanelPattern(static_cast<int>(factor->nsuper), static_cast<const int*>(factor->super),
                           static_cast<const int*>(factor->pi), static_cast<const int*>(factor->s));
    place.resize(n);
    for (std::size_t k = 0; k < n; ++k) place[static_cast<const int*>(factor->Perm)[k]] = static_cast<int>(k);
  }
  cholmod_free_factor(&factor, &common);
  cholmod_free_sparse(&matrix, &common);
  cholmod_finish(&common);
  if (place.empty()) throw limit_error("out of memory: the tire's stiffness matrix could not be analysed");
  return pattern;
}

/// Pattern of the lower triangle: nodes that share an element are coupled.
std::vector<std::vector<int>> ring_pattern(int columns, int across) {
  FURROW_ASSERT(columns >= 3 && across > 0, columns, across);
  std::vector<std::vector<int>> pattern(6 * static_cast<std::size_t>(columns) * across);
  for (int node = 0; node < columns * across; ++node) {
    std::set<int> near;
    for (int di = -1; di <= 1; ++di)
      for (int dj = -1; dj <= 1; ++dj) {
        const int j = node % across + dj, i = (node / across + di + columns) % columns;
        if (j >= 0 && j < across && i * across + j >= node) near.insert(i * across + j);
      }
    for (int c = 0; c < 6; ++c)
      for (const int other : near)
        for (int r = other == node ? c : 0; r < 6; ++r) pattern[6 * node + c].push_back(6 * other + r);
  }
  return pattern;
}

}  // namespace

ShellFactor::ShellFactor(const ShellLayout& layout)
    : layout_(layout), across_(layout.rows - 2), changed_(layout.batches(), 1) {
  PanelPattern pattern = analyze(ring_pattern(layout.columns, across_), place_);
  values_.assign(block(sectors(), 0, 0, 0), 0.0f);
  std::vector<FrontalFactor::Entry> entries;
  const auto add_entry = [&](std::size_t value, int a, int b, int sector) {
    const int p = place_[a], q = place_[b];
    entries.push_back({static_cast<int>(value), std::max(p, q), std::min(p, q), sector});
  };
  for (int sector = 0; sector < sectors(); ++sector) {
    const int width = std::min(kDoubleLanes, layout.columns - sector * kDoubleLanes);  // elements
    for (int column = 0; column <= width; ++column)
      for (int row = 0; row < across_; ++row)
        for (int kind = 0; kind < kKinds; ++kind) {
          const int other_row = row + kKindRow[kind], other_column = column + kKindColumn[kind];
          if (other_row < 0 || other_row >= across_ || other_column > width) continue;
          const int i = (sector * kDoubleLanes + column) % layout.columns,
                    other_i = (sector * kDoubleLanes + other_column) % layout.columns;
          const int node = i * across_ + row, other = other_i * across_ + other_row;
          for (int r = 0; r < 6; ++r)
            for (int c = 0; c < (kind == 0 ? r + 1 : 6); ++c)
              add_entry(block(sector, column, row, kind) + 6 * r + c, 6 * other + r, 6 * node + c, sector);
        }
  }
  factor_ = FrontalFactor(std::move(pattern), entries, sectors());
  x_.resize(factor_.pattern().padded_size());
}

std::size_t ShellFactor::block(int sector, int column, int row, int kind) const {
  return 36 * ((static_cast<std::size_t>(sector * (kDoubleLanes + 1) + column) * across_ + row) * kKinds + kind);
}

void ShellFactor::clear(int sector) {
  FURROW_ASSERT(in_range(sector, sectors()), sector, sectors());
  std::fill(values_.begin() + block(sector, 0, 0, 0), values_.begin() + block(sector + 1, 0, 0, 0), 0.0f);
  changed_[sector] = 1;
}

void ShellFactor::add(const BatchTangent& tangent, const ElementMass& mass, double mass_factor, int j, int sector) {
  FURROW_ASSERT(in_range(sector, sectors()) && in_range(j, layout_.rows - 1), sector, sectors(), j, layout_.rows);
  for (int lane = 0; lane < kDoubleLanes && sector * kDoubleLanes + lane < layout_.columns; ++lane)
    for (int n = 0; n < 4; ++n)
      for (int m = 0; m < 4; ++m) {
        const int row = j + kRow[m] - 1, other = j + kRow[n] - 1;
        if (row < 0 || row >= across_ || other < 0 || other >= across_) continue;
        int kind = 0;
        while (kind < kKinds && (kKindColumn[kind] != kColumn[n] - kColumn[m] || kKindRow[kind] != other - row)) ++kind;
        if (kind == kKinds) continue;  // the transposed block holds it
        float* to = values_.data() + block(sector, lane + kColumn[m], row, kind);
        for (int r = 0; r < 6; ++r)
          for (int c = 0; c < (kind == 0 ? r + 1 : 6); ++c) {
            const int a = 6 * n + r, b = 6 * m + c;
            double value = a >= b ? tangent.k[a][b][lane] : tangent.k[b][a][lane];
            if (r % 3 == c % 3) value += mass_factor * mass(2 * n + r / 3, 2 * m + c / 3);
            to[6 * r + c] += static_cast<float>(value);
          }
      }
}

void ShellFactor::add_node(const Mat3& stiffness, int sector, int lane, int row) {
  FURROW_ASSERT(in_range(sector, sectors()) && in_range(lane, kDoubleLanes + 1), sector, sectors(), lane);
  FURROW_ASSERT(in_range(row - 1, across_), row, across_);
  float* to = values_.data() + block(sector, lane, row - 1, 0);
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c <= r; ++c) to[6 * r + c] += static_cast<float>(stiffness(r, c));
}

bool ShellFactor::factorize(int threads) {
  if (!factor_.factorize(values_, changed_, threads)) {
    std::fill(changed_.begin(), changed_.end(), 1);
    return false;
  }
  std::fill(changed_.begin(), changed_.end(), 0);
  return true;
}

void ShellFactor::solve(const Mat3& turn, const Field& rhs, Field& x, int threads) {
  FURROW_ASSERT(rhs.size() == layout_.size() && x.size() == layout_.size(), rhs.size(), x.size(), layout_.size());
  const int columns = layout_.columns, stride = layout_.stride();
  const Mat3 back = turn.transpose();
  for (int j = 0; j < across_; ++j)
    for (int s = 0; s < 2; ++s) {
      const double* p = rhs.data() + layout_.offset(j + 1, 3 * s);
      for (int i = 0; i < columns; ++i, ++p) {
        const Vec3 v = back * Vec3(p[0], p[stride], p[2 * stride]);
        const int* to = place_.data() + 6 * (i * across_ + j) + 3 * s;
        for (int c = 0; c < 3; ++c) x_[to[c]] = static_cast<float>(v[c]);
      }
    }
  factor_.solve(x_.data(), threads);
  for (int j = 0; j < across_; ++j)
    for (int s = 0; s < 2; ++s) {
      double* p = x.data() + layout_.offset(j + 1, 3 * s);
      for (int i = 0; i < columns; ++i, ++p) {
        const int* from = place_.data() + 6 * (i * across_ + j) + 3 * s;
        const Vec3 v = turn * Vec3(x_[from[0]], x_[from[1]], x_[from[2]]);
        p[0] = v.x(), p[stride] = v.y(), p[2 * stride] = v.z();
      }
    }
}

}  // namespace furrow::tire
