// The index by which ParaView opens a run: a time series of tire surfaces and grains, from the frames that exist.
#pragma once

#include <filesystem>
#include <string>

namespace furrow::output {

/// Writes <run>/results.xdmf for the frames under <run>/frames: the instants at which every tire and the terrain left a
/// readable file. None when there are no frames.
/// @returns what to warn of: a file of an instant before the last that is lost; empty: none @throws Error(io)
std::string write_xdmf_index(const std::filesystem::path& run);

}  // namespace furrow::output
