// Compares a run with soil theory: predictions of Bekker, Wong & Reece and Janosi & Hanamoto for a rigid wheel of the
// run's size, load and slip, on soil with the parameters that `furrow soil` found.
#pragma once

#include <filesystem>
#include <string>

namespace furrow::terrain::soil {

/// Writes soil_estimate.json into the run's folder. Returns a line for users.
/// @param soil_file soil.json, or the folder that contains it
/// @throws Error(bad_input) naming file and key if a value is missing or not a number, Error(io)
std::string write_soil_estimate(const std::filesystem::path& run, const std::filesystem::path& soil_file);

}  // namespace furrow::terrain::soil
