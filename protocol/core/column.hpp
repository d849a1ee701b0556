// Columns of result tables: their names, and how a line follows from the values measured at every synchronization. A
// struct whose fields are all columns has one list of them:
//
//   void visit_fields(FieldsOf<VehicleRow> auto& r, auto&& visit) {
//     visit(r.speed, column::mean("speed_m_per_s", "m/s"));
//   }
//
// The table's columns, their means, the saved state and the files follow from this list.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include "protocol/core/fields.hpp"

namespace furrow {

/// Kind of a value in a line. Consecutive lines are some communication intervals apart.
enum class ColumnKind {
  instant,     // the value at the line's time
  mean,        // over the intervals since the previous line; the value of each interval is measured
  cumulative,  // since the start of the run; summed up where it is measured
  largest,     // since the start of the run; kept where it is measured
  derived,     // computed from the other columns of the line
};

struct Column : Field {  // its name ends in its unit
  ColumnKind kind = ColumnKind::instant;
  double sign = 1.0;       // of the written value
  const char* after = "";  // for a column that is added to a table: the column that it follows; empty: it comes last

  constexpr Column negative() const {
    Column other = *this;
    other.sign = -sign;
    return other;
  }
  constexpr Column following(const char* column) const {
    Column other = *this;
    other.after = column;
    return other;
  }
};

namespace column {
inline constexpr Column instant(const char* name, const char* unit = "-") {
  return {{name, unit, role::column}, ColumnKind::instant};
}
inline constexpr Column mean(const char* name, const char* unit = "-") {
  return {{name, unit, role::column}, ColumnKind::mean};
}
inline constexpr Column cumulative(const char* name, const char* unit = "-") {
  return {{name, unit, role::column}, ColumnKind::cumulative};
}
inline constexpr Column largest(const char* name, const char* unit = "-") {
  return {{name, unit, role::column}, ColumnKind::largest};
}
inline constexpr Column derived(const char* name, const char* unit = "-") {
  return {{name, unit, role::column}, ColumnKind::derived};
}
}  // namespace column

/// The columns of a struct whose fields are all columns, in the order of its list.
template <HasFields Row>
std::vector<Column> columns_of() {
  std::vector<Column> columns;
  const Row row{};
  visit_fields(row, [&](const double&, const Column& column) { columns.push_back(column); });
  return columns;
}

/// The values of such a struct, in the same order. @pre values.size() is the number of its columns
template <HasFields Row>
void get_values(const Row& row, std::span<double> values) {
  std::size_t i = 0;
  visit_fields(row, [&](const double& value, const Column&) { values[i++] = value; });
}

/// Sets a struct from the values that get_values returned.
template <HasFields Row>
void set_values(Row& row, std::span<const double> values) {
  std::size_t i = 0;
  visit_fields(row, [&](double& value, const Column&) { value = values[i++]; });
}

/// A line of a table, addressed by column names.
struct LineView {
  std::span<const Column> columns;
  std::span<const double> values;  // tire: its reach below the rim centre, inflated, with the camber of the rig, m

  /// NaN if there is no such column.
  double operator[](std::string_view name) const {
    for (std::size_t i = 0; i < columns.size(); ++i)
      if (name == columns[i].name) return values[i];
    return std::numeric_limits<double>::quiet_NaN();
  }
};

}  // namespace furrow
