// The time series on disk: one table of columns serves the CSV file, the HDF5 file and the documentation.
#pragma once

#include <cstdio>
#include <filesystem>
#include <span>
#include <string>

#include "nodes/series_row.hpp"

namespace furrow {

struct SeriesColumn {
  const char* name;  // ends in its unit
  double (*value)(const SeriesRow&);
};

/// All columns; those that users script against come first and keep their place.
std::span<const SeriesColumn> series_columns();

/// timeseries.csv, 17 digits. Every write is checked.
class SeriesWriter {
 public:
  /// @throws Error(io)
  explicit SeriesWriter(const std::filesystem::path& file);
  ~SeriesWriter();
  SeriesWriter(const SeriesWriter&) = delete;
  SeriesWriter& operator=(const SeriesWriter&) = delete;

  void add(const SeriesRow& row);
  void flush();

 private:
  void check(bool ok);
  std::filesystem::path file_;
  std::FILE* stream_;
};

}  // namespace furrow
