// The time series on disk: one table of columns serves the CSV file, the HDF5 file and the documentation.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "nodes/checkpoint/series_mark.hpp"
#include "nodes/output/series_row.hpp"
#include "protocol/core/hash.hpp"

namespace furrow::output {

struct SeriesColumn {
  const char* name;  // ends in its unit
  double sign;       // of the value as it is written
  double* (*field)(SeriesRow&);
  double value(SeriesRow row) const { return sign * *field(row); }
};

/// All columns; those that users script against come first and keep their place.
std::span<const SeriesColumn> series_columns();

/// timeseries.csv, 17 digits. Every write is checked.
class SeriesWriter {
 public:
  /// @throws Error(io)
  explicit SeriesWriter(const std::filesystem::path& file);
  /// Goes on with a file that was cut short or written on since `mark`: cuts it there.
  /// @param rows receives its lines
  /// @throws Error(io) when the file does not begin with what the mark stands for
  SeriesWriter(const std::filesystem::path& file, const checkpoint::SeriesMark& mark,
               std::vector<SeriesRow>& rows);

  void add(const SeriesRow& row);
  void flush();
  /// Flushes to the disk.
  checkpoint::SeriesMark mark();

 private:
  void check(bool ok);
  void write(const std::string& text);
  std::filesystem::path file_;
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> stream_;
  Hash hash_;
  std::int64_t bytes_ = 0, lines_ = 0;
};

}  // namespace furrow::output
