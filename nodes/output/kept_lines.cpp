#include "nodes/output/kept_lines.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"

namespace furrow::output {
namespace {

/// Opens a file without a name for reading and writing. Negative if this fails.
int open_nameless(const std::filesystem::path& folder) {
  const int file = open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (file >= 0 || (errno != EOPNOTSUPP && errno != EISDIR && errno != EINVAL)) return file;
  std::string name = (folder / ".furrow-lines-XXXXXX").string();  // the file system does not support nameless files
  const int named = mkostemp(name.data(), O_CLOEXEC);
  if (named >= 0) unlink(name.c_str());
  return named;
}

off_t place_of(std::size_t numbers) { return static_cast<off_t>(numbers * sizeof(double)); }

}  // namespace

void KeptLines::keep_in(const std::filesystem::path& folder) {
  FURROW_ASSERT(!file_, folder);
  folder_ = folder;
  const int file = open_nameless(folder);
  if (file >= 0) file_.reset(fdopen(file, "rb+"));
  if (!file_)
    throw io_error(folder_.string(), std::string("cannot take the lines of a series: ") + std::strerror(errno));
}

void KeptLines::add(std::span<const double> line) {
  FURROW_ASSERT(!line.empty() && (lines_ == 0 || line.size() == width_), line.size(), width_);
  width_ = line.size();
  last_.resize(width_ * kBlock);
  const std::size_t place = lines_ % kBlock;
  for (std::size_t k = 0; k < width_; ++k) last_[k * kBlock + place] = line[k];
  if (place + 1 == kBlock) {
    if (!file_) keep_in(std::filesystem::temp_directory_path());
    const auto* bytes = reinterpret_cast<const char*>(last_.data());
    const std::size_t size = last_.size() * sizeof(double);
    const off_t at = place_of(whole_blocks() * last_.size());
    for (std::size_t done = 0; done < size;) {
      const ssize_t more = pwrite(fileno(file_.get()), bytes + done, size - done, at + static_cast<off_t>(done));
      if (more <= 0 && errno != EINTR)
        throw io_error(folder_.string(), std::string("cannot take the lines of a series: ") + std::strerror(errno));
      done += static_cast<std::size_t>(std::max<ssize_t>(more, 0));
    }
  }
  ++lines_;
}

void KeptLines::read(std::size_t block, std::size_t column, std::span<double> to) const {
  auto* bytes = reinterpret_cast<char*>(to.data());
  const off_t at = place_of((block * width_ + column) * kBlock);
  for (std::size_t done = 0; done < to.size_bytes();) {
    const ssize_t more =
        pread(fileno(file_.get()), bytes + done, to.size_bytes() - done, at + static_cast<off_t>(done));
    if (more == 0 || (more < 0 && errno != EINTR))
      throw io_error(folder_.string(), std::string("does not give back the lines of a series: ") +
                                           std::strerror(more == 0 ? EIO : errno));
    done += static_cast<std::size_t>(std::max<ssize_t>(more, 0));
  }
}

std::span<const double> KeptLines::line(std::size_t i) const {
  FURROW_ASSERT(i < lines_, i, lines_);
  const std::size_t block = i / kBlock;
  if (block < whole_blocks() && read_ != block + 1) {
    block_.resize(width_ * kBlock);
    read_ = 0;
    read(block, 0, block_);
    read_ = block + 1;
  }
  const std::vector<double>& from = block < whole_blocks() ? block_ : last_;
  line_.resize(width_);
  for (std::size_t k = 0; k < width_; ++k) line_[k] = from[k * kBlock + i % kBlock];
  return line_;
}

std::vector<double> KeptLines::column(std::size_t k) const {
  FURROW_ASSERT(k < width_ || lines_ == 0, k, width_);
  std::vector<double> all(lines_);
  const std::size_t whole = whole_blocks();
  for (std::size_t block = 0; block < whole; ++block) read(block, k, std::span(all).subspan(block * kBlock, kBlock));
  for (std::size_t i = whole * kBlock; i < lines_; ++i) all[i] = last_[k * kBlock + i % kBlock];
  return all;
}

}  // namespace furrow::output
