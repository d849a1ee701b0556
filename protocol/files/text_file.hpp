// Whole files. Written, they appear or do not (new_file.hpp).
#pragma once

#include <filesystem>
#include <string>

#include "protocol/core/hash.hpp"

namespace furrow {

/// All bytes of a file. @throws Error(io)
std::string read_whole_file(const std::filesystem::path& file);

/// The bytes of a text file in UTF-8 that a user wrote.
/// @param expected what should be there, for messages: "a scenario in JSON"
/// @throws Error(bad_input) when it is missing, a directory, a device, empty, too large, or not UTF-8
std::string read_text_file(const std::filesystem::path& file, const std::string& expected);

/// Adds all bytes of a file of any size. @throws Error(io)
void add_file(Hash& hash, const std::filesystem::path& file);

/// Hash of a file's bytes and of a text's, in hexadecimal digits. @throws Error(io)
std::string file_hash(const std::filesystem::path& file);
std::string text_hash(const std::string& text);

/// @throws Error(io) naming the file
void write_whole_file(const std::filesystem::path& file, const std::string& text);

/// Flushes what was renamed, made or removed in a folder to the disk. @throws Error(io)
void sync_folder(const std::filesystem::path& folder);

/// Offset of the first byte that is not UTF-8 (RFC 3629), or npos.
std::size_t find_invalid_utf8(const std::string& text);

/// "line:column" of a byte, both from 1, the column in characters.
std::string place_in_text(const std::string& text, std::size_t offset);

}  // namespace furrow
