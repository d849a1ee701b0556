// Profiles of hard ground from files: CSV with the columns x_m and z_m, or OpenCRG by the ending .crg.
#pragma once

#include <filesystem>

#include "terrain/rigid/ground_profile.hpp"

namespace furrow::terrain {

inline constexpr std::size_t kMostProfilePoints = 100000;

/// @param v of the cut of an OpenCRG file, m; CSV has none
/// @throws Error(bad_input) naming the file, the line and what was expected
ProfilePoints read_road(const std::filesystem::path& file, double v);

}  // namespace furrow::terrain
