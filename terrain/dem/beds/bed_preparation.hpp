// A bed ready for use: from the cache, from a file, or newly made (placed, settled, and compacted if asked).
#pragma once

#include <filesystem>

#include "protocol/core/archive.hpp"
#include "terrain/dem/beds/bed_settling.hpp"
#include "terrain/dem/dem_options.hpp"

namespace furrow::terrain::dem {

struct PreparedBed {
  Archive bed;           // input of GrainSolver::restore; "bed/" has how the bed was made
  SettleResult settled;  // result of making it; `steps` only if it was made now
  bool from_cache = false;
  std::filesystem::path file;  // file that contains it: in the cache, or the user's; empty: none
};

/// The options with gravity straight down, under which a bed settles; a slope is tilted with its bed.
DemOptions level(DemOptions options);

/// @throws Error(bad_input) for mistakes in options or the user's file, Error(physics) when a grain is lost.
PreparedBed prepare_bed(const DemOptions& options, const ProgressCall& progress);

/// Prepares the bed and restores it in the solver. If a bed of the cache is inconsistent, this is reported to
/// `progress` and the bed is made again. @throws Error(io) naming the user's file if that is inconsistent
PreparedBed load_bed(GrainSolver& solver, const DemOptions& options, const ProgressCall& progress);

/// Solid fraction of the middle of the bed under 20 % more gravity, a test of whether it would collapse.
double solid_fraction_under_weight(const GrainSolver& bed, const DemOptions& options, const ProgressCall& progress);

/// False for a settled bed from the user's file, which is used unchanged.
bool bed_is_settled_anew(const DemOptions& options);

/// A bed in the form that prepare_bed reads from a file.
Archive bed_archive(const GrainSolver& solver, const DemOptions& options, const SettleResult& settled);

/// Checks the options of the bed before it is made. @throws Error(bad_input)
void check_bed_options(const DemOptions& options);

}  // namespace furrow::terrain::dem
