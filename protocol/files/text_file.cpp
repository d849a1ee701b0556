#include "protocol/files/text_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <vector>

#include <fmt/format.h>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/new_file.hpp"

namespace furrow {
namespace {

Error failed(const std::filesystem::path& file, const std::string& what) {
  return io_error(file.string(), what + ": " + std::strerror(errno));
}

/// Passes the stream to `use`, block by block; `use` returns false when it needs no more. @returns false after an error
template <class Use>
bool read_blocks(std::ifstream& in, const Use& use) {
  std::vector<char> block(1 << 20);
  while (in) {
    in.read(block.data(), static_cast<std::streamsize>(block.size()));
    if (!use(block.data(), static_cast<std::size_t>(in.gcount()))) return true;
  }
  return in.eof();
}

Error unreadable(const std::filesystem::path& file) {
  const int error = errno;
  return io_error(file.string(), error == 0        ? "does not exist or cannot be read"
                                 : error == ENOENT ? "does not exist"
                                                   : fmt::format("cannot be read ({})", std::strerror(error)));
}

/// Requires a regular file of a size that a person may have written.
void check_text_file(const std::filesystem::path& file, const std::string& expected) {
  const std::string name = file.string();
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status))
    throw input_error(name, "",
                      (error && error.value() != ENOENT ? "cannot be read (" + error.message() + ")"
                       : file == "-"                    ? "does not exist, and standard input is not read"
                                                        : "does not exist") +
                          ", expected " + expected);
  if (std::filesystem::is_directory(status)) throw input_error(name, "", "is a directory, expected " + expected);
  if (!std::filesystem::is_regular_file(status))
    throw input_error(name, "", "is not a regular file, expected " + expected);
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (!error && size > kMaxText)
    throw input_error(name, "", "is {} MB large, expected {} of at most 16 MB", size >> 20, expected);
}

}  // namespace

std::string read_whole_file(const std::filesystem::path& file, std::uintmax_t most) {
  errno = 0;
  std::string bytes;
  std::ifstream in(file, std::ios::binary);
  const bool good = in && read_blocks(in, [&](const char* block, std::size_t count) {
                      bytes.append(block, count);
                      return bytes.size() <= most;
                    });
  if (!good) throw unreadable(file);
  if (bytes.size() > most) throw io_error(file.string(), fmt::format("is larger than {} MB", most >> 20));
  return bytes;
}

void add_file(Hash& hash, const std::filesystem::path& file) {
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  const bool good = in && read_blocks(in, [&](const char* block, std::size_t count) {
                      hash.add(block, count);
                      return true;
                    });
  if (!good) throw unreadable(file);
}

std::string file_hash(const std::filesystem::path& file) {
  Hash hash;
  add_file(hash, file);
  return hash.hex();
}

std::string text_hash(const std::string& text) {
  Hash hash;
  hash.add(text);
  return hash.hex();
}

std::string read_text_file(const std::filesystem::path& file, const std::string& expected, bool utf8) {
  const std::string name = file.string();
  check_text_file(file, expected);
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  std::string text;
  // Only bytes that are read count, not the size that the system reports: files grow, and kernel files report none.
  const bool good = in && read_blocks(in, [&](const char* block, std::size_t count) {
                      text.append(block, count);
                      return text.size() <= kMaxText;
                    });
  if (!good) throw input_error(name, "", "cannot be read ({}), expected {}", std::strerror(errno), expected);
  if (text.size() > kMaxText) throw input_error(name, "", "is too large, expected {} of at most 16 MB", expected);
  if (std::all_of(text.begin(), text.end(), [](unsigned char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }))
    throw input_error(name, "", "is empty, expected " + expected);
  if (const std::size_t bad = find_invalid_utf8(text); utf8 && bad != std::string::npos)
    throw input_error(name + ":" + place_in_text(text, bad), "", "byte 0x{:02x} is not UTF-8, expected {} in UTF-8",
                      static_cast<unsigned char>(text[bad]), expected);
  return text;
}

std::string_view trimmed(std::string_view text) {
  const std::size_t from = text.find_first_not_of(" \t\r"), to = text.find_last_not_of(" \t\r");
  return from == std::string_view::npos ? std::string_view() : text.substr(from, to - from + 1);
}

std::size_t utf8_length(const std::string& text, std::size_t at) {
  FURROW_ASSERT(at < text.size(), at, text.size());
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[at + k]); };
  const unsigned lead = byte(0);
  if (lead < 0x80) return 1;
  const std::size_t length = lead < 0xC2 ? 0 : lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : lead < 0xF5 ? 4 : 0;
  if (length == 0 || at + length > text.size()) return 0;
  unsigned code = lead & (0x7FU >> length);
  for (std::size_t k = 1; k < length; ++k) {
    if ((byte(k) & 0xC0U) != 0x80U) return 0;
    code = code << 6 | (byte(k) & 0x3FU);
  }
  const bool overlong = (length == 3 && code < 0x800) || (length == 4 && code < 0x10000);
  return overlong || (code >= 0xD800 && code < 0xE000) || code > 0x10FFFF ? 0 : length;
}

std::size_t find_invalid_utf8(const std::string& text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = utf8_length(text, at);
    if (length == 0 || text[at] == '\0') return at;
    at += length;
  }
  return std::string::npos;
}

std::string place_in_text(const std::string& text, std::size_t offset) {
  offset = std::min(offset, text.size());
  const std::size_t line =
      1 + static_cast<std::size_t>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(offset), '\n'));
  const std::size_t newline = offset == 0 ? std::string::npos : text.rfind('\n', offset - 1);
  std::size_t column = 1;
  for (std::size_t i = newline == std::string::npos ? 0 : newline + 1; i < offset; ++i)
    column += (static_cast<unsigned char>(text[i]) & 0xC0U) != 0x80U;
  return fmt::format("{}:{}", line, column);
}

void sync_folder(const std::filesystem::path& folder) {
  const int handle = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (handle < 0) throw failed(folder, "cannot open to flush");
  const int result = fsync(handle);
  close(handle);
  if (result != 0) throw failed(folder, "cannot flush to the disk");
}

void write_whole_file(const std::filesystem::path& file, const std::string& text) {
  NewFile made(file);
  made.write(text);
  made.publish();
}

}  // namespace furrow
