// A table of results: one subject (a wheel, a body, the vehicle), its columns, and the lines written so far. The same
// columns serve the CSV file, the HDF5 file and the reading of a file with which a run continues.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "nodes/checkpoint/series_mark.hpp"
#include "nodes/output/kept_lines.hpp"
#include "protocol/core/column.hpp"
#include "protocol/core/hash.hpp"

namespace furrow::output {

struct Table {
  std::string subject;  // "wheel0", "vehicle"
  std::vector<Column> columns;
  KeptLines kept;  // as in the file

  std::size_t lines() const { return kept.size(); }
  /// Valid until the next call.
  std::span<const double> line(std::size_t i) const { return kept.line(i); }
  std::optional<std::size_t> find(std::string_view column) const;
  /// The values of a column; none if there is no such column.
  std::vector<double> column(std::string_view name) const;
};

/// Inserts `added` into `base` in the places that Column::after sets.
std::vector<Column> merged_columns(std::vector<Column> base, std::span<const Column> added);

/// A table as CSV, 17 digits. Every write is checked.
class TableWriter {
 public:
  /// @throws Error(io)
  TableWriter(const std::filesystem::path& file, const Table& table);
  /// Continues a file that was cut short or written on since `mark`: cuts it there.
  /// @param table receives its lines
  /// @throws Error(io) if the file does not begin with the marked content, or has other columns
  TableWriter(const std::filesystem::path& file, const checkpoint::SeriesMark& mark, Table& table);

  /// @param line a value for each column of the table
  void add(std::span<const double> line);
  void flush();
  /// Checks whether the file still exists with the flushed content; an editor may have replaced it.
  bool stands() const;
  /// Writes the file again; it replaces the present one only when it is whole.
  /// @param table that holds all lines @throws Error(io)
  void write_again(const Table& table);
  /// Flushes to the disk.
  checkpoint::SeriesMark mark();

 private:
  const char* read_line(const char* text, std::span<double> line) const;
  void check(bool ok);
  void only_append();
  void write(const std::string& text);
  std::filesystem::path file_;
  std::string subject_;
  std::size_t width_;  // columns of the table
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> stream_;
  Hash hash_;
  std::int64_t bytes_ = 0, lines_ = 0;
};

}  // namespace furrow::output
