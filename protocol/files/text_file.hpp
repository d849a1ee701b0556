// Whole files appear or do not: written under a temporary name, flushed to the disk, then renamed.
#pragma once

#include <filesystem>
#include <string>

namespace furrow {

/// @throws Error(io) naming the file
void write_whole_file(const std::filesystem::path& file, const std::string& text);

/// Flushes `written` to the disk and renames it to `file`. @throws Error(io)
void publish_file(const std::filesystem::path& written, const std::filesystem::path& file);

/// Flushes what was renamed, made or removed in a folder to the disk. @throws Error(io)
void sync_folder(const std::filesystem::path& folder);

/// The temporary name beside `file`.
std::filesystem::path temporary_name(const std::filesystem::path& file);

}  // namespace furrow
