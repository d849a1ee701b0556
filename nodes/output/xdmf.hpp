// The index with which ParaView opens a run: a time series of tire surfaces and grains, from the existing frames.
#pragma once

#include <filesystem>
#include <string>

namespace furrow::output {

/// Writes <run>/results.xdmf for the frames under <run>/frames: the instants with a readable file of every tire and the
/// terrain. Writes none if there are no frames.
/// @returns a warning of a lost file before the last instant; empty: none @throws Error(io)
std::string write_xdmf_index(const std::filesystem::path& run);

}  // namespace furrow::output
