// A bed ready for use: from the cache, from a file, or made: placed, settled, compacted if asked.
#pragma once

#include <filesystem>

#include "protocol/core/archive.hpp"
#include "terrain/dem/beds/bed_settling.hpp"
#include "terrain/dem/dem_options.hpp"

namespace furrow::terrain::dem {

struct PreparedBed {
  Archive bed;           // what GrainSolver::restore takes, and how it was made under "bed/"
  SettleResult settled;  // when it was made; `steps` only if it was made now
  bool from_cache = false;
  std::filesystem::path file;  // that holds it: in the cache, or the user's; empty: none
};

/// A bed settles under gravity straight down; a slope is tilted with its bed.
DemOptions level(DemOptions options);

/// @throws Error(bad_input) for what options or the user's file have wrong, Error(physics) when a grain is lost.
PreparedBed prepare_bed(const DemOptions& options, const ProgressCall& progress);

/// The same, and gives the solver the bed. One of the cache that does not hold together is reported to `progress`, and
/// made again. @throws Error(io) naming the user's file when that does not
PreparedBed load_bed(GrainSolver& solver, const DemOptions& options, const ProgressCall& progress);

/// Solid fraction of the middle of the bed under 20 % more gravity: a look at whether it would fall in.
double solid_fraction_under_weight(const GrainSolver& bed, const DemOptions& options, const ProgressCall& progress);

/// False for a settled bed from the user's file, which is taken as it is.
bool bed_is_settled_anew(const DemOptions& options);

/// A bed as prepare_bed reads it from a file.
Archive bed_archive(const GrainSolver& solver, const DemOptions& options, const SettleResult& settled);

/// What can be said against the options of the bed before it is made. @throws Error(bad_input)
void check_bed_options(const DemOptions& options);

}  // namespace furrow::terrain::dem
