// Tables of numbers that people wrote as CSV: a line with the names of the columns, then rows with a value for each
// column, separated by commas. Empty lines and lines that begin with # are skipped; there are no quotes.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "protocol/core/error.hpp"

namespace furrow {

class CsvFile {
 public:
  /// @param expected what should be there, for messages: "a CSV file of waypoints"
  /// @param columns that are allowed; the file must have the first and at least one more
  /// @throws Error(bad_input) naming file and line
  CsvFile(const std::filesystem::path& file, const std::string& expected, const std::vector<std::string>& columns);

  std::size_t row_count() const { return rows_.size(); }
  bool has(const std::string& column) const { return index_of(column) < columns_.size(); }
  /// @pre has(column)
  const std::string& text(std::size_t row, const std::string& column) const;
  /// @throws Error(bad_input) unless the value is finite. @pre has(column)
  double number(std::size_t row, const std::string& column) const;

  Error wrong(std::size_t row, const std::string& what) const { return wrong_line(rows_[row].line, what); }

 private:
  struct Row {
    int line;  // from 1
    std::vector<std::string> cells;
  };
  void take_header(const std::vector<std::string>& cells, int line, const std::vector<std::string>& known);
  std::size_t index_of(const std::string& column) const;
  Error wrong_line(int line, const std::string& what) const;

  std::string name_;
  std::vector<std::string> columns_;
  std::vector<Row> rows_;
};

}  // namespace furrow
