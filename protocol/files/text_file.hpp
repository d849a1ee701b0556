// Whole files. A file that is written appears whole or not at all (new_file.hpp).
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "protocol/core/hash.hpp"

namespace furrow {

/// Most bytes of a text that a person wrote.
inline constexpr std::uintmax_t kMaxText = 16 << 20;

/// All bytes of a file. @throws Error(io), also when there are more than `most`
std::string read_whole_file(const std::filesystem::path& file, std::uintmax_t most = UINTMAX_MAX);

/// The bytes of a text file in UTF-8 that a user wrote.
/// @param expected what should be there, for messages: "a scenario in JSON" @param utf8 false: the caller judges bytes
/// @throws Error(bad_input) when it is missing, a directory, a device, empty, too large, or not UTF-8
std::string read_text_file(const std::filesystem::path& file, const std::string& expected, bool utf8 = true);

/// Adds all bytes of a file of any size. @throws Error(io)
void add_file(Hash& hash, const std::filesystem::path& file);

/// Hash of a file's bytes, and of a text's, in hexadecimal digits. @throws Error(io)
std::string file_hash(const std::filesystem::path& file);
std::string text_hash(const std::string& text);

/// @throws Error(io) naming the file
void write_whole_file(const std::filesystem::path& file, const std::string& text);

/// Flushes renamed, created and removed files of a folder to the disk. @throws Error(io)
void sync_folder(const std::filesystem::path& folder);

/// The text without blanks (space, tab, carriage return) at both ends.
std::string_view trimmed(std::string_view text);

/// Bytes of the UTF-8 character (RFC 3629) that begins at `at`; 0 if none does. @pre at < text.size()
std::size_t utf8_length(const std::string& text, std::size_t at);

/// Offset of the first byte that is not UTF-8, or is zero; npos if there is none.
std::size_t find_invalid_utf8(const std::string& text);

/// "line:column" of a byte; both count from 1, and the column counts characters.
std::string place_in_text(const std::string& text, std::size_t offset);

}  // namespace furrow
