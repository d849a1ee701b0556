// Borders between the ranks' parts of the bin along x, so that all ranks own about as many grains. They follow from
// numbers of grains, not from measured times, and so are the same in each run.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace furrow::terrain::liggghts {

/// Distribution of the grains along the bin.
class Crowd {
 public:
  /// @pre length > 0, m
  explicit Crowd(double length) : length_(length), counts_(kCells, 0) {}

  void add(double x);  // m
  std::span<const std::int64_t> counts() const { return counts_; }
  /// Adds the counts of other ranks, given one after another.
  void set_sum_of(std::span<const std::int64_t> counts);
  /// ranks − 1 positions, m, rising, between which the ranks own equal numbers of grains; none if there are no grains.
  std::vector<double> borders(int ranks) const;

 private:
  static constexpr int kCells = 2048;
  double length_;
  std::vector<std::int64_t> counts_;
};

}  // namespace furrow::terrain::liggghts
