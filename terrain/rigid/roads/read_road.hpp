// Profiles of hard ground from files: CSV with the columns x_m and z_m, or, cut along x, any file of read_map.hpp.
#pragma once

#include <filesystem>

#include "terrain/rigid/ground_profile.hpp"
#include "terrain/rigid/roads/road_place.hpp"

namespace furrow::terrain {

inline constexpr std::size_t kMostProfilePoints = 100000;

/// @throws Error(bad_input) naming the file, the line and what was expected
ProfilePoints read_road(const std::filesystem::path& file, const RoadPlace& place);

}  // namespace furrow::terrain
