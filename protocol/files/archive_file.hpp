// A node's saved state on disk: every array of an Archive as a dataset of its own type, bit for bit.
//   attributes  format_version, kind = "state", arrays (their number), checksum
//   /state/<name>  with ':' in place of the '/' in the archive's names
// The checksum is FNV-1a over names, types and bytes in the order of the names.
#pragma once

#include <filesystem>

#include "protocol/core/archive.hpp"

namespace furrow {

/// The file appears whole or not at all. @throws Error(io)
void write_archive(const std::filesystem::path& file, const Archive& archive);

/// @throws Error(io) naming the file when it is missing, cut short, damaged, of another kind or of a newer format
Archive read_archive(const std::filesystem::path& file);

}  // namespace furrow
