// The lines of a table during a run: the latest in memory, the others in a file without a name. A rank therefore needs
// no more memory for a million lines than for a thousand.
//
// The file has blocks of kBlock lines, column by column: one column is read without the others, and whole lines with
// one read per block. The system removes the file when the process ends for any reason.
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

namespace furrow::output {

class KeptLines {
 public:
  static constexpr std::size_t kBlock = 256;  // lines

  /// Makes the file in this folder. Without this call it is made among temporary files when needed. @throws Error(io)
  void keep_in(const std::filesystem::path& folder);
  /// @pre as many numbers as in every line before @throws Error(io)
  void add(std::span<const double> line);

  std::size_t size() const { return lines_; }
  /// Valid until the next call. @throws Error(io)
  std::span<const double> line(std::size_t i) const;
  /// Returns a column of all lines. @throws Error(io)
  std::vector<double> column(std::size_t k) const;

 private:
  std::size_t whole_blocks() const { return lines_ / kBlock; }
  void read(std::size_t block, std::size_t column, std::span<double> to) const;

  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::filesystem::path folder_;
  std::unique_ptr<std::FILE, Close> file_;
  std::size_t width_ = 0, lines_ = 0;
  std::vector<double> last_;           // the block that is not whole yet
  mutable std::vector<double> block_;  // the whole block that was read last
  mutable std::size_t read_ = 0;       // its number + 1; 0: none
  mutable std::vector<double> line_;
};

}  // namespace furrow::output
