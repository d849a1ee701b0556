#include "protocol/files/csv_file.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>
#include <utility>

#include <fmt/format.h>

#include "protocol/core/assert.hpp"
#include "protocol/files/nearest_words.hpp"
#include "protocol/files/printable.hpp"
#include "protocol/files/text_file.hpp"

namespace furrow {
namespace {

constexpr const char* kByteOrderMark = "\xEF\xBB\xBF";  // as spreadsheets write it

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  for (std::size_t at = 0;;) {
    const std::size_t comma = line.find(',', at);
    cells.emplace_back(trimmed(std::string_view(line).substr(at, comma - at)));
    if (comma == std::string::npos) return cells;
    at = comma + 1;
  }
}

/// Why a header looks like the output of another program; empty if it does not.
std::string foreign_header(const std::vector<std::string>& cells) {
  const std::string& first = cells.front();
  for (const auto& [separator, name] : {std::pair{';', "';'"}, {'\t', "tabs"}})
    if (first.find(separator) != std::string::npos)
      return fmt::format("has {} between its values, expected commas, and numbers with a decimal point: 0.1", name);
  if (first.starts_with('"') || first.starts_with('\'')) return "has quotes around its values, expected none";
  if (cells.back().empty()) return "ends with a comma, expected a value after it or no comma";
  double number = 0.0;
  if (std::from_chars(first.data(), first.data() + first.size(), number).ec == std::errc())
    return fmt::format("begins with the number '{}', expected the names of the columns first", excerpt(first));
  return {};
}

}  // namespace

CsvFile::CsvFile(const std::filesystem::path& file, const std::string& expected,
                 const std::vector<std::string>& columns)
    : name_(file.string()) {
  std::string text = read_text_file(file, expected);
  if (text.starts_with(kByteOrderMark)) text.erase(0, 3);
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    if (trimmed(line).empty() || line.starts_with('#')) continue;
    std::vector<std::string> cells = cells_of(line);
    if (columns_.empty()) {
      take_header(cells, number, columns);
      continue;
    }
    if (cells.size() != columns_.size())
      throw wrong_line(number,
                       fmt::format("has {} values, expected {}{}", cells.size(), columns_.size(),
                                   cells.size() == 2 * columns_.size() ? ", with decimal points, not commas" : ""));
    rows_.push_back({number, std::move(cells)});
  }
  if (rows_.empty()) throw input_error(name_, "", "has no rows of values, expected " + expected);
}

void CsvFile::take_header(const std::vector<std::string>& cells, int line, const std::vector<std::string>& known) {
  if (std::find(known.begin(), known.end(), cells.front()) == known.end() || cells.back().empty())
    if (const std::string foreign = foreign_header(cells); !foreign.empty())
      throw wrong_line(line, fmt::format("{}; the columns are: {}", foreign, fmt::join(known, ", ")));
  for (const std::string& cell : cells) {
    if (std::find(known.begin(), known.end(), cell) == known.end())
      throw wrong_line(line, "column '" + excerpt(cell) + "' " + unknown_text(nearest_words(cell, known), known));
    if (has(cell)) throw wrong_line(line, "column '" + cell + "' is there twice, expected once");
    columns_.push_back(cell);
  }
  const std::string others = fmt::format("'{}'", fmt::join(known.begin() + 1, known.end(), "', '"));
  if (!has(known.front()))
    throw wrong_line(line, fmt::format("has no column '{}', expected it and any of {}", known.front(), others));
  if (columns_.size() < 2)
    throw wrong_line(line, fmt::format("has no column besides '{}', expected any of {}", known.front(), others));
}

std::size_t CsvFile::index_of(const std::string& column) const {
  return static_cast<std::size_t>(std::find(columns_.begin(), columns_.end(), column) - columns_.begin());
}

const std::string& CsvFile::text(std::size_t row, const std::string& column) const {
  FURROW_ASSERT(row < rows_.size() && has(column), row, column);
  return rows_[row].cells[index_of(column)];
}

double CsvFile::number(std::size_t row, const std::string& column) const {
  const std::string& cell = text(row, column);
  double value = 0.0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc() || end != cell.data() + cell.size() || !std::isfinite(value))
    throw wrong(row, fmt::format("{} is '{}', expected a number", column, excerpt(cell)));
  return value;
}

Error CsvFile::wrong_line(int line, const std::string& what) const {
  return input_error(name_, fmt::format("line {}", line), what);
}

}  // namespace furrow
