#include "nodes/output/table.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/text_file.hpp"

namespace furrow::output {
namespace {

/// @param order  which column stands at each place
std::string header_line(const Table& table, const std::vector<std::size_t>& order) {
  std::string header;
  for (const std::size_t i : order) header += (header.empty() ? "" : ",") + std::string(table.columns[i].name);
  return header + '\n';
}

std::vector<std::string> names_in(std::string_view header) {
  std::vector<std::string> names;
  for (std::size_t from = 0; from <= header.size();) {
    const std::size_t to = std::min(header.find(',', from), header.size());
    names.emplace_back(header.substr(from, to - from));
    from = to + 1;
  }
  return names;
}

}  // namespace

std::optional<std::size_t> Table::find(std::string_view column) const {
  for (std::size_t i = 0; i < columns.size(); ++i)
    if (column == columns[i].name) return i;
  return std::nullopt;
}

std::vector<double> Table::column(std::string_view name) const {
  std::vector<double> found;
  if (const auto place = find(name))
    for (std::size_t i = *place; i < values.size(); i += columns.size()) found.push_back(values[i]);
  return found;
}

std::vector<Column> merged_columns(std::vector<Column> base, std::span<const Column> added) {
  for (const Column& column : added) {
    const std::string_view after = column.after;
    auto place = std::find_if(base.begin(), base.end(), [&](const Column& c) { return after == c.name; });
    if (place != base.end()) ++place;
    // Those that follow the same column are in the order in which they were added.
    while (place != base.end() && after == place->after) ++place;
    base.insert(place, column);
  }
  return base;
}

TableWriter::TableWriter(const std::filesystem::path& file, const Table& table)
    : file_(file), subject_(table.subject), order_(table.columns.size()), stream_(std::fopen(file.c_str(), "wb")) {
  check(stream_ != nullptr);
  only_append();
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  write(header_line(table, order_));
}

TableWriter::TableWriter(const std::filesystem::path& file, const checkpoint::SeriesMark& mark, Table& table)
    : file_(file), subject_(table.subject), stream_(std::fopen(file.c_str(), "rb+")) {
  if (!stream_ && errno == ENOENT)
    throw io_error(file_.string(),
                   "is missing, and a run cannot be continued without the lines that the checkpoint knows: "
                   "bring it back, or begin again with furrow run --overwrite");
  if (!stream_) throw io_error(file_.string(), std::string("cannot be opened to continue it: ") + std::strerror(errno));
  std::error_code error;
  const std::uintmax_t there = std::filesystem::file_size(file, error);
  const bool all = !error && std::cmp_less_equal(mark.bytes, there);
  std::string text(all ? static_cast<std::size_t>(mark.bytes) : 0, '\0');
  text.resize(std::fread(text.data(), 1, text.size(), stream_.get()));
  hash_.add(text);
  const std::size_t end = text.find('\n');
  if (!all || hash_.hex() != mark.checksum || end == std::string::npos)
    throw io_error(file_.string(), "does not hold the lines that the checkpoint knows: it was changed since");
  // Of a copy that shares its files with this one: what it holds must not change.
  if (struct stat own{}; fstat(fileno(stream_.get()), &own) == 0 && own.st_nlink > 1) {
    write_whole_file(file_, text);
    stream_.reset(std::fopen(file_.c_str(), "rb+"));
    check(stream_ != nullptr);
  }
  take_order(std::string_view(text).substr(0, end), table);
  const char* at = text.c_str() + end + 1;
  for (std::int64_t line = 0; line < mark.lines; ++line) {
    at = read_line(at, table);
    if (!at) throw io_error(file_.string(), fmt::format("line {} cannot be read", line + 2));
  }
  bytes_ = mark.bytes;
  lines_ = mark.lines;
  check(ftruncate(fileno(stream_.get()), bytes_) == 0);
  check(std::fseek(stream_.get(), 0, SEEK_END) == 0);
  only_append();
}

/// Else the system would fill what somebody cut off with zeros, and the file would have its length again.
void TableWriter::only_append() { check(fcntl(fileno(stream_.get()), F_SETFL, O_APPEND) == 0); }

void TableWriter::take_order(std::string_view header, const Table& table) {
  for (const std::string& name : names_in(header)) {
    const auto place = table.find(name);
    if (!place)
      throw io_error(file_.string(),
                     fmt::format("has a column '{}' that this program does not write: continue with the program "
                                 "that began the run",
                                 name));
    if (std::find(order_.begin(), order_.end(), *place) != order_.end())
      throw io_error(file_.string(), fmt::format("has the column '{}' twice", name));
    order_.push_back(*place);
  }
  for (std::size_t i = 0; i < table.columns.size(); ++i)
    if (std::find(order_.begin(), order_.end(), i) == order_.end())
      throw io_error(file_.string(),
                     fmt::format("lacks the column '{}' that this program writes: continue with the program that "
                                 "began the run",
                                 table.columns[i].name));
}

/// The line at `text`, which ends in a line feed; null when it is none.
const char* TableWriter::read_line(const char* text, Table& table) const {
  const std::size_t begin = table.values.size();
  table.values.resize(begin + order_.size());
  for (std::size_t i = 0; i < order_.size(); ++i) {
    char* end = nullptr;
    table.values[begin + order_[i]] = std::strtod(text, &end);
    if (end == text || *end != (i + 1 == order_.size() ? '\n' : ',')) return nullptr;
    text = end + 1;
  }
  return text;
}

void TableWriter::check(bool ok) {
  if (!ok) throw io_error(file_.string(), std::string("cannot write: ") + std::strerror(errno));
}

void TableWriter::write(const std::string& text) {
  check(std::fwrite(text.data(), 1, text.size(), stream_.get()) == text.size());
  hash_.add(text);
  bytes_ += static_cast<std::int64_t>(text.size());
}

void TableWriter::add(std::span<const double> values) {
  FURROW_ASSERT(values.size() == order_.size(), values.size(), order_.size());
  std::string line;
  for (const std::size_t i : order_)
    fmt::format_to(std::back_inserter(line), "{}{:.17g}", line.empty() ? "" : ",", values[i]);
  line += '\n';
  write(line);
  ++lines_;
}

void TableWriter::flush() { check(std::fflush(stream_.get()) == 0); }

bool TableWriter::stands() const {
  struct stat own {};
  struct stat there {};
  return fstat(fileno(stream_.get()), &own) == 0 && lstat(file_.c_str(), &there) == 0 && own.st_dev == there.st_dev &&
         own.st_ino == there.st_ino && std::cmp_equal(own.st_size, bytes_);
}

void TableWriter::write_again(const Table& table) {
  FURROW_ASSERT(std::cmp_equal(table.lines(), lines_), table.lines(), lines_);
  std::error_code error;
  std::filesystem::remove(file_, error);
  stream_.reset(std::fopen(file_.c_str(), "wbx"));
  check(stream_ != nullptr);
  only_append();
  hash_ = Hash();
  bytes_ = lines_ = 0;
  write(header_line(table, order_));
  for (std::size_t line = 0; line < table.lines(); ++line) add(table.line(line));
  flush();
}

checkpoint::SeriesMark TableWriter::mark() {
  flush();
  check(fsync(fileno(stream_.get())) == 0);
  return {bytes_, lines_, hash_.hex(), subject_};
}

}  // namespace furrow::output
