// Makes the lines of a table from the measurements at every synchronization: each column by its kind.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "protocol/core/archive.hpp"
#include "protocol/core/column.hpp"

namespace furrow::output {

class LineBuilder {
 public:
  explicit LineBuilder(std::vector<Column> columns)
      : columns_(std::move(columns)), values_(columns_.size()), line_(columns_.size()) {}

  const std::vector<Column>& columns() const { return columns_; }

  /// Adds an interval, with a value for each column: means are summed, all others replaced.
  void add(std::span<const double> measured);
  /// Returns the line for the intervals added since the last take(), valid until the next. Derived columns stay as
  /// measured.
  std::span<const double> take();

  /// Values after the last add(); means are sums since the last line.
  std::span<const double> now() const { return values_; }
  /// Factor that turns these sums into means.
  double share() const { return count_ > 0.0 ? 1.0 / count_ : 0.0; }

  /// Saves every column under `<folder><its name>`, so that the order of columns may change.
  void save(Archive& archive, const std::string& folder) const;
  /// @throws Error(io) if a column is missing
  void restore(const Archive& archive, const std::string& folder);

 private:
  std::vector<Column> columns_;
  std::vector<double> values_, line_;
  double count_ = 0.0;  // intervals in the sums
};

}  // namespace furrow::output
