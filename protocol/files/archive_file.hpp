// An Archive on disk: every array as a dataset of its own type, bit for bit.
//   attributes  format_version; kind; kind_version; checksum, archive_hash() in hexadecimal digits
//   datasets    the arrays; those of a saved state as state/<name>, with ':' for each '/' in their names
#pragma once

#include <filesystem>
#include <functional>

#include "protocol/core/archive.hpp"

namespace furrow {

/// Kind of an archive: its contents and how they are stored.
struct ArchiveKind {
  const char* name;
  const char* words;     // "a saved state"
  std::int64_t version;  // of its arrays
  const char* group;     // group of the arrays, with ':' for each '/' in names; empty: no group, names unchanged
};

inline constexpr ArchiveKind kSavedState{"state", "a saved state", 1, "state"};

/// The file appears whole or not at all. If several processes write it at once, the last one wins. `each` is called
/// before every array and may throw to stop. @throws Error(io)
void write_archive(const std::filesystem::path& file, const Archive& archive, const ArchiveKind& kind = kSavedState,
                   const std::function<void()>& each = {});

/// @param each is called before every array and may throw to stop
/// @throws Error(io) naming the file when it is missing, cut short, damaged, of another kind or of another version
Archive read_archive(const std::filesystem::path& file, const ArchiveKind& kind = kSavedState,
                     const std::function<void()>& each = {});

/// Whether an HDF5 file is of this kind, or too damaged to decide.
bool may_be_archive(const std::filesystem::path& file, const ArchiveKind& kind);

}  // namespace furrow
