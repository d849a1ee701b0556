// The stretch of a run over which its summary averages.
#pragma once

#include <cmath>
#include <functional>
#include <string_view>
#include <vector>

#include "nodes/output/table.hpp"
#include "nodes/output/wheel_row.hpp"

namespace furrow::output {

/// What the table of a wheel says from line `first` on, read line by line where it is asked for: a table may be larger
/// than the memory. The table outlives it.
class WheelRows {
 public:
  WheelRows() = default;
  explicit WheelRows(const Table& table, std::size_t first = 0);

  std::size_t size() const { return table_ ? table_->lines() - first_ : 0; }
  bool empty() const { return size() == 0; }
  WheelRow operator[](std::size_t i) const;
  WheelRow front() const { return (*this)[0]; }
  WheelRow back() const { return (*this)[size() - 1]; }

  struct Iterator {
    const WheelRows* rows;
    std::size_t i;
    WheelRow operator*() const { return (*rows)[i]; }
    Iterator& operator++() { return ++i, *this; }
    bool operator==(const Iterator& other) const { return i == other.i; }
  };
  Iterator begin() const { return {this, 0}; }
  Iterator end() const { return {this, size()}; }

 private:
  const Table* table_ = nullptr;
  std::size_t first_ = 0;
  std::vector<std::size_t> places_;  // of WheelRow's columns in the table
  std::vector<double> signs_;
};

/// The averaging window: lines from `first` on, whose means describe the time from `before` to the last line. Columns
/// that the rig adds are asked for by name, those of every wheel by their row.
struct Window {
  WheelRows rows;
  WheelRow before;
  bool whole_facets = false;
  const Table* table = nullptr;
  std::size_t first = 0;

  double duration() const { return rows.empty() ? 0.0 : rows.back().time - before.time; }
  template <class Get>
  double mean(Get get) const {
    double sum = 0.0;
    for (const WheelRow& row : rows) sum += std::invoke(get, row);
    return rows.empty() ? NAN : sum / static_cast<double>(rows.size());
  }
  template <class Get>
  double rate(Get get) const {
    return rows.empty() ? NAN : (std::invoke(get, rows.back()) - std::invoke(get, before)) / duration();
  }
  template <class Get>
  std::vector<double> samples_by(Get get) const {
    std::vector<double> values;
    for (const WheelRow& row : rows) values.push_back(std::invoke(get, row));
    return values;
  }
  /// None when the rig has no such column.
  std::vector<double> samples(std::string_view column) const;
  /// NaN when the rig has no such column.
  double mean_of(std::string_view column) const;
};

/// The window from the time `from` to the end of the table, shortened at its beginning to a whole number of facets of
/// the tire, as far as 50 lines or a quarter of it allow; empty where it holds no line.
/// The table outlives the window.
Window averaging_window(const Table& table, double from, int facets);

}  // namespace furrow::output
