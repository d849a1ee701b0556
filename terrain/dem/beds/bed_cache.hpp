// Settled beds on disk: an Archive as an HDF5 file, found by a digest of everything that made the bed.
#pragma once

#include <filesystem>
#include <string>

#include "protocol/core/archive.hpp"
#include "protocol/files/program_id.hpp"
#include "terrain/dem/dem_options.hpp"

namespace furrow::terrain::dem {

/// Digest of everything that determines the bits of a settled bed: geometry, seed, law, material, settling step,
/// format, and the arithmetic of the build that settles it.
std::string bed_digest(const DemOptions& options, const std::string& arithmetic = arithmetic_id());

/// ${XDG_CACHE_HOME:-~/.cache}/furrow/beds/<digest>.h5; empty if neither variable contains a directory.
std::filesystem::path bed_cache_file(const std::string& digest);

/// The file is complete or absent, also with two writers. @throws Error(io), and what `progress` throws
void write_bed(const std::filesystem::path& file, const Archive& archive, const ProgressCall& progress = {});

/// Writes a bed to the cache, with the digest of its inputs. `bed` is unchanged afterwards.
void keep_bed(const std::filesystem::path& file, Archive& bed, const std::string& digest,
              const ProgressCall& progress = {});

/// @param digest receives that of the file; unchanged if the file has none
/// @throws Error(io) when the file is missing, not one of ours, damaged (checksum) or of another format; and whatever
/// `progress` throws
Archive read_bed(const std::filesystem::path& file, const ProgressCall& progress = {}, std::string* digest = nullptr);

/// Whether an HDF5 file is a settled bed of furrow, or too damaged to decide.
bool may_be_bed(const std::filesystem::path& file);

}  // namespace furrow::terrain::dem
