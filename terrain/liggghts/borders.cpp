#include "terrain/liggghts/borders.hpp"

#include <algorithm>
#include <numeric>

#include "protocol/core/assert.hpp"

namespace furrow::terrain::liggghts {

void Crowd::add(double x) {
  const double cell = x / length_ * kCells;
  ++counts_[cell > 0.0 ? std::min(static_cast<int>(std::min(cell, 1e9)), kCells - 1) : 0];
}

void Crowd::set_sum_of(std::span<const std::int64_t> counts) {
  FURROW_ASSERT(counts.size() % kCells == 0, counts.size());
  std::fill(counts_.begin(), counts_.end(), 0);
  for (std::size_t k = 0; k < counts.size(); ++k) counts_[k % kCells] += counts[k];
}

std::vector<double> Crowd::borders(int ranks) const {
  const std::int64_t all = std::accumulate(counts_.begin(), counts_.end(), std::int64_t{0});
  std::vector<double> places;
  if (all == 0) return places;
  std::int64_t before = 0;
  int cell = 0;
  for (int rank = 1; rank < ranks; ++rank) {
    const double wanted = static_cast<double>(all) * rank / ranks;
    while (cell + 1 < kCells && static_cast<double>(before + counts_[cell]) < wanted) before += counts_[cell++];
    const double inside =
        counts_[cell] > 0 ? (wanted - static_cast<double>(before)) / static_cast<double>(counts_[cell]) : 0.5;
    places.push_back(length_ * (cell + std::clamp(inside, 0.0, 1.0)) / kCells);
  }
  return places;
}

}  // namespace furrow::terrain::liggghts
