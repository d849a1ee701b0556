// Settled beds on disk: an Archive as an HDF5 file, found again by a digest of everything that made the bed.
#pragma once

#include <filesystem>
#include <string>

#include "protocol/core/archive.hpp"
#include "protocol/files/program_id.hpp"
#include "terrain/dem/dem_options.hpp"

namespace furrow::terrain::dem {

/// Digest of what decides the bits of a settled bed: geometry, seed, law, material, settling step, format, and the
/// arithmetic of the build that settles it.
std::string bed_digest(const DemOptions& options, const std::string& arithmetic = arithmetic_id());

/// ${XDG_CACHE_HOME:-~/.cache}/furrow/beds/<digest>.h5; empty when neither variable names a directory.
std::filesystem::path bed_cache_file(const std::string& digest);

/// Complete or absent, also with two writers. @throws Error(io), and what `progress` throws
void write_bed(const std::filesystem::path& file, const Archive& archive, const ProgressCall& progress = {});

/// The same in the cache, with the digest of what the bed is of. `bed` is as before afterwards.
void keep_bed(const std::filesystem::path& file, Archive& bed, const std::string& digest,
              const ProgressCall& progress = {});

/// @param digest receives that of the file; stays as it is for one that holds none
/// @throws Error(io) when the file is missing, not one of ours, damaged (checksum) or of another format; and what
/// `progress` throws
Archive read_bed(const std::filesystem::path& file, const ProgressCall& progress = {}, std::string* digest = nullptr);

/// Whether an HDF5 file is a settled bed of furrow, or too damaged to decide.
bool may_be_bed(const std::filesystem::path& file);

}  // namespace furrow::terrain::dem
