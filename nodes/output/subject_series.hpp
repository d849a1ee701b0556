// The table of one subject during a run: the columns of every wheel, if it is a wheel, and those that the rig adds.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "nodes/output/line_builder.hpp"
#include "nodes/output/series_builder.hpp"
#include "nodes/output/table.hpp"
#include "rigs/rig.hpp"

namespace furrow::output {

class SubjectSeries {
 public:
  /// @param wheel for a wheel; the tables of other subjects begin with the time
  explicit SubjectSeries(const rigs::Subject& subject, std::optional<SeriesBuilder> wheel = std::nullopt);

  /// The subject's table without a line.
  Table empty_table() const { return {name_, columns_, {}}; }
  const std::vector<Column>& columns() const { return columns_; }
  /// @pre the subject is a wheel
  const SeriesBuilder& wheel() const { return *wheel_; }

  /// Adds a synchronization n ≥ 1. @pre the subject is a wheel
  void add(const StepReports& reports, const rigs::Rig& rig, int subject);
  /// Adds a synchronization of any other subject. @param time t_n, s
  void add(double time, const rigs::Rig& rig, int subject);

  /// Returns the line for the intervals added since the last take(), as in the file; valid until the next.
  std::span<const double> take(const rigs::Rig& rig, int subject);

  void save(Archive& archive) const;
  void restore(const Archive& archive);

 private:
  void measure(const rigs::Rig& rig, int subject);
  void place(std::span<const double> values, std::span<const std::size_t> places);
  std::vector<std::size_t> places_of(std::span<const Column> columns) const;

  std::string name_;
  std::optional<SeriesBuilder> wheel_;
  LineBuilder time_, added_;                             // added_: the rig's columns
  std::vector<Column> columns_;                          // of the table
  std::vector<std::size_t> base_places_, added_places_;  // in columns_
  std::vector<double> measured_, row_, line_;
};

}  // namespace furrow::output
