// The part of a run over which its summary averages.
#pragma once

#include <cmath>
#include <functional>
#include <string_view>
#include <vector>

#include "nodes/output/table.hpp"
#include "nodes/output/wheel_row.hpp"

namespace furrow::output {

/// A wheel's table from line `first` on. It is read line by line on demand, because a table may exceed the memory. The
/// table outlives it.
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

/// The averaging window: lines from `first` on, whose means describe the time from `before` to the last line. Its
/// functions take the row's member for a column of every wheel, and the name for a column of the rig.
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
  /// None if the rig does not have this column.
  std::vector<double> samples(std::string_view column) const;
  /// NaN if the rig does not have this column.
  double mean_of(std::string_view column) const;
};

/// Returns the window from the time `from` to the end of the table; empty if it has no line. Its beginning is shortened
/// to a whole number of the tire's facets, by at most 50 lines, or by up to a quarter for one facet. The table outlives
/// the window.
Window averaging_window(const Table& table, double from, int facets);

}  // namespace furrow::output
