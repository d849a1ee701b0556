// Whole files: reading returns the written text, and files of people are limited in size.
#include "protocol/files/text_file.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <utility>

#include "protocol/core/error.hpp"
#include "protocol/files/cache_folder.hpp"
#include "tests/refusal.hpp"
#include "tests/temporary_folder.hpp"

namespace furrow {
namespace {

using testing::TemporaryFolder;

/// More than one block of the readers, with every byte in it.
std::string many_bytes() {
  std::string bytes((3 << 20) + 17, '\0');
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(i * i + i / 251);
  return bytes;
}

TEST(TextFile, bytes_come_back_as_written_and_nothing_else_is_left) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "bytes";
  for (const std::string& bytes : {std::string(), std::string("a\0b\r\n", 5), many_bytes()}) {
    write_whole_file(file, bytes);
    EXPECT_EQ(read_whole_file(file), bytes);
  }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(TextFile, the_hash_of_a_file_is_that_of_its_bytes) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "bytes";
  write_whole_file(file, many_bytes());
  EXPECT_EQ(file_hash(file), text_hash(many_bytes()));
  EXPECT_EQ(text_hash(""), "cbf29ce484222325");   // FNV-1a, 64 bits, by its definition
  EXPECT_EQ(text_hash("a"), "af63dc4c8601ec8c");  // its published test vector
}

TEST(TextFile, what_cannot_be_read_is_an_error_naming_the_file) {
  const TemporaryFolder folder;
  for (const auto& [file, why] :
       {std::pair{folder.path() / "none", "does not exist"}, {folder.path(), "cannot be read (Is a directory)"}}) {
    expect_refused(ExitCode::io, {file.string(), why}, [&] { read_whole_file(file); });
    expect_refused(ExitCode::io, {file.string(), why}, [&] { file_hash(file); });
  }
  expect_refused(ExitCode::bad_input, {"-: does not exist, and standard input is not read, expected a text"},
                 [] { read_text_file("-", "a text"); });
}

TEST(CacheFolder, of_a_relative_path_is_passed_over) {
  const char* const before = std::getenv("XDG_CACHE_HOME");
  const std::string kept = before ? before : "";
  setenv("XDG_CACHE_HOME", "/var/cache/me", 1);
  EXPECT_EQ(cache_folder("beds"), "/var/cache/me/furrow/beds");
  setenv("XDG_CACHE_HOME", "rel/dir", 1);
  EXPECT_NE(cache_folder("beds"), "rel/dir/furrow/beds");
  before ? setenv("XDG_CACHE_HOME", kept.c_str(), 1) : unsetenv("XDG_CACHE_HOME");
}

TEST(TextFile, a_user_s_text_is_a_regular_file_of_a_readable_size) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "large";
  const auto refusal = [](const std::filesystem::path& path) {
    return without_file(furrow::refusal(ExitCode::bad_input, [&] { read_text_file(path, "a text"); }), path);
  };
  std::ofstream(file) << "x";
  std::filesystem::resize_file(file, (16 << 20) + 1);
  EXPECT_EQ(refusal(file), "is 16 MB large, expected a text of at most 16 MB");
  EXPECT_EQ(refusal(folder.path()), "is a directory, expected a text");
  EXPECT_EQ(refusal("/dev/null"), "is not a regular file, expected a text");
  EXPECT_EQ(refusal(folder.path() / "none"), "does not exist, expected a text");
  // The kernel reports size zero for its files; their contents are read nevertheless.
  EXPECT_FALSE(read_text_file("/proc/self/status", "a text").empty());
}

}  // namespace
}  // namespace furrow
