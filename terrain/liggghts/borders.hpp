// Where along x the ranks' parts of the bin meet: so that all own about as many grains. The numbers of grains decide,
// not measured times: the borders of a run are the same each time.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace furrow::terrain::liggghts {

/// How many grains stand where along the bin.
class Crowd {
 public:
  /// @pre length > 0, m
  explicit Crowd(double length) : length_(length), counts_(kCells, 0) {}

  void add(double x);  // m
  std::span<const std::int64_t> counts() const { return counts_; }
  /// Adds those of other ranks, one behind the other.
  void set_sum_of(std::span<const std::int64_t> counts);
  /// ranks − 1 places that leave as many grains on either side as they should, m, rising; none when there is no grain.
  std::vector<double> borders(int ranks) const;

 private:
  static constexpr int kCells = 2048;
  double length_;
  std::vector<std::int64_t> counts_;
};


}  // namespace furrow::terrain::liggghts
