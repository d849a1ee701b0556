#include "tire/ring/folded_band.hpp"

#include <algorithm>

#include "protocol/core/assert.hpp"

namespace furrow::tire {

FoldedBand::FoldedBand(int segments)
    : unknowns_(2 * segments),
      place_(segments),
      band_(static_cast<std::size_t>(kStride) * (unknowns_ + kBelow)),
      inverse_(unknowns_) {
  FURROW_ASSERT(segments >= kMinSegments, segments);
  for (int j = 0; j < segments; ++j) place_[j] = 2 * (j < (segments + 1) / 2 ? 2 * j : 2 * (segments - j) - 1);
}

bool FoldedBand::factorize(const RingTangent& blocks) {
  std::fill(band_.begin(), band_.end(), 0.0);
  const int n = unknowns_ / 2;
  const auto put = [&](int row, int column, double value) {
    if (row < column) std::swap(row, column);
    band_[static_cast<std::size_t>(kStride) * column + (row - column)] = value;
  };
  for (int d = 0; d < 3; ++d)
    for (int j = 0; j < n; ++j) {
      const int at = place_[j], with = place_[j + d < n ? j + d : j + d - n];
      put(at, with, blocks.uu[d][j]);
      put(at, with + 1, blocks.uv[d][j]);
      if (d > 0) put(at + 1, with, blocks.vu[d][j]);
      put(at + 1, with + 1, blocks.vv[d][j]);
    }
  bool positive = true;
  for (int i = 0; i < unknowns_; ++i) {
    double* const column = &band_[static_cast<std::size_t>(kStride) * i];
    positive = positive && column[0] > 0.0;
    const double inverse = inverse_[i] = 1.0 / column[0];
    double below[kBelow];
    for (int k = 0; k < kBelow; ++k) below[k] = column[k + 1];
    for (int k = 0; k < kBelow; ++k) {
      const double factor = below[k] * inverse;
      double* const target = column + static_cast<std::ptrdiff_t>(kStride) * (k + 1);
      for (int m = k; m < kBelow; ++m) target[m - k] -= factor * below[m];
      column[k + 1] = factor;
    }
  }
  return positive;
}

void FoldedBand::solve(double* x) const {
  for (int i = 0; i < unknowns_; ++i) {
    const double* const column = &band_[static_cast<std::size_t>(kStride) * i];
    const double* const at = x + static_cast<std::ptrdiff_t>(kLanes) * i;
    for (int k = 1; k <= kBelow; ++k)
      for (int lane = 0; lane < kLanes; ++lane) x[kLanes * (i + k) + lane] -= column[k] * at[lane];
  }
  for (int i = unknowns_ - 1; i >= 0; --i) {
    const double* const column = &band_[static_cast<std::size_t>(kStride) * i];
    double sum[kLanes];
    for (int lane = 0; lane < kLanes; ++lane) sum[lane] = x[kLanes * i + lane] * inverse_[i];
    for (int k = 1; k <= kBelow; ++k)
      for (int lane = 0; lane < kLanes; ++lane) sum[lane] -= column[k] * x[kLanes * (i + k) + lane];
    for (int lane = 0; lane < kLanes; ++lane) x[kLanes * i + lane] = sum[lane];
  }
}

}  // namespace furrow::tire
