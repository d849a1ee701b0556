#include "nodes/output/table.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/new_file.hpp"
#include "protocol/files/text_file.hpp"

namespace furrow::output {
namespace {

std::string header_line(const Table& table) {
  std::string header;
  for (const Column& column : table.columns) header += (header.empty() ? "" : ",") + std::string(column.name);
  return header + '\n';
}

std::string line_text(std::span<const double> values) { return fmt::format("{:.17g}\n", fmt::join(values, ",")); }

}  // namespace

std::optional<std::size_t> Table::find(std::string_view column) const {
  for (std::size_t i = 0; i < columns.size(); ++i)
    if (column == columns[i].name) return i;
  return std::nullopt;
}

std::vector<double> Table::column(std::string_view name) const {
  const auto place = find(name);
  return place ? kept.column(*place) : std::vector<double>{};
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
    : file_(file), subject_(table.subject), width_(table.columns.size()), stream_(std::fopen(file.c_str(), "wb")) {
  check(stream_ != nullptr);
  only_append();
  write(header_line(table));
}

TableWriter::TableWriter(const std::filesystem::path& file, const checkpoint::SeriesMark& mark, Table& table)
    : file_(file), subject_(table.subject), width_(table.columns.size()), stream_(std::fopen(file.c_str(), "rb+")) {
  if (!stream_ && errno == ENOENT)
    throw io_error(file_.string(),
                   "is missing, and a run cannot be continued without the lines that the checkpoint knows: bring it "
                   "back, or begin again with furrow run --overwrite");
  if (!stream_) throw io_error(file_.string(), std::string("cannot be opened to continue it: ") + std::strerror(errno));
  std::error_code error;
  const std::uintmax_t there = std::filesystem::file_size(file, error);
  const bool all = !error && std::cmp_less_equal(mark.bytes, there);
  std::string text(all ? static_cast<std::size_t>(mark.bytes) : 0, '\0');
  text.resize(std::fread(text.data(), 1, text.size(), stream_.get()));
  hash_.add(text);
  if (!all || hash_.hex() != mark.checksum)
    throw io_error(file_.string(), "does not hold the lines that the checkpoint knows: it was changed since");
  const std::string header = header_line(table);
  if (!text.starts_with(header))
    throw io_error(file_.string(),
                   "has other columns than this program writes: continue with the program that began the run");
  // For a copy that shares its files with this one: the content of the copy must not change.
  if (struct stat own{}; fstat(fileno(stream_.get()), &own) == 0 && own.st_nlink > 1) {
    write_whole_file(file_, text);
    stream_.reset(std::fopen(file_.c_str(), "rb+"));
    check(stream_ != nullptr);
  }
  const char* at = text.c_str() + header.size();
  std::vector<double> values(width_);
  for (std::int64_t line = 0; line < mark.lines; ++line) {
    at = read_line(at, values);
    if (at) table.kept.add(values);
    if (!at) throw io_error(file_.string(), fmt::format("line {} cannot be read", line + 2));
  }
  bytes_ = mark.bytes;
  lines_ = mark.lines;
  check(ftruncate(fileno(stream_.get()), bytes_) == 0);
  check(std::fseek(stream_.get(), 0, SEEK_END) == 0);
  only_append();
}

/// Appends only: otherwise the system would fill a part that somebody cut off with zeros, and the file would have its
/// old length.
void TableWriter::only_append() { check(fcntl(fileno(stream_.get()), F_SETFL, O_APPEND) == 0); }

/// Reads the line at `text`, which ends in a line feed; null if it is not a line.
const char* TableWriter::read_line(const char* text, std::span<double> line) const {
  for (std::size_t i = 0; i < width_; ++i) {
    char* end = nullptr;
    line[i] = std::strtod(text, &end);
    if (end == text || *end != (i + 1 == width_ ? '\n' : ',')) return nullptr;
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
  FURROW_ASSERT(values.size() == width_, values.size(), width_);
  write(line_text(values));
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
  // The present file, even if partial, may be all from which a checkpoint can continue: it stays if the disk is full.
  NewFile made(file_);
  hash_ = Hash();
  bytes_ = 0;
  const auto add_text = [&](const std::string& text) {
    made.write(text);
    hash_.add(text);
    bytes_ += static_cast<std::int64_t>(text.size());
  };
  add_text(header_line(table));
  for (std::size_t line = 0; line < table.lines(); ++line) add_text(line_text(table.line(line)));
  made.publish();
  stream_.reset(std::fopen(file_.c_str(), "rb+"));
  check(stream_ != nullptr);
  check(std::fseek(stream_.get(), 0, SEEK_END) == 0);
  only_append();
}

checkpoint::SeriesMark TableWriter::mark() {
  flush();
  check(fsync(fileno(stream_.get())) == 0);
  return {bytes_, lines_, hash_.hex(), subject_};
}

}  // namespace furrow::output
