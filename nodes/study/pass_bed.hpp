// The bed of a further pass: the terrain after a run, without the tire, after a rest.
#pragma once

#include <filesystem>

#include "terrain/dem/beds/bed_after_run.hpp"

namespace furrow::study {

/// @param run   folder of a finished run on grains; its last checkpoint is read
/// @param rest  simulated time that the bed rests before the next pass, s
/// @param file  receives the bed, for `terrain.bed`
/// @throws Error
terrain::dem::SettleResult make_pass_bed(const std::filesystem::path& run, double rest, const ProgressCall& progress,
                                         const std::filesystem::path& file);

}  // namespace furrow::study
