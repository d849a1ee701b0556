// Makes the lines of a table from what is measured at every synchronization: each column by its kind.
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

  /// Once per interval, a value for each column: means are summed, all others replaced.
  void add(std::span<const double> measured);
  /// The line for the intervals added since the last take(): valid until the next. Derived columns are left as
  /// measured.
  std::span<const double> take();

  /// As of the last add(); means are sums since the last line.
  std::span<const double> now() const { return values_; }
  /// What turns those sums into means.
  double share() const { return count_ > 0.0 ? 1.0 / count_ : 0.0; }

  /// Every column under `<folder><its name>`, so that the order of columns may change.
  void save(Archive& archive, const std::string& folder) const;
  /// @throws Error(io) when a column is missing
  void restore(const Archive& archive, const std::string& folder);

 private:
  std::vector<Column> columns_;
  std::vector<double> values_, line_;
  double count_ = 0.0;  // intervals in the sums
};

}  // namespace furrow::output
