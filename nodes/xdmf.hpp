// The index by which ParaView opens a run: a time series of tire surfaces and grains, from the frames that exist.
#pragma once

#include <filesystem>

namespace furrow {

/// Writes <run>/results.xdmf for all complete frames under <run>/frames. Nothing when there are none. @throws Error(io)
void write_xdmf_index(const std::filesystem::path& run);

}  // namespace furrow
