// Heights of the ground: a profile, alike for all y, or a height map.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "protocol/core/ground_heights.hpp"
#include "terrain/rigid/ground_profile.hpp"
#include "terrain/rigid/roads/road_place.hpp"
#include "terrain/terrain_spec.hpp"

namespace furrow::terrain {

struct HeightMap;

struct GroundShape {
  ProfilePoints profile;
  std::shared_ptr<const HeightMap> map;  // in place of the profile

  bool given() const { return map || !profile.empty(); }
  UnevenPart uneven() const;
  /// For people: ", heights from -0.02 to 0.05 m over 120 m"; empty where none is given. Looks at every height.
  std::string range() const;
  /// What of a file is not as it says, or not likely, for TerrainDescription. Looks at every height.
  std::vector<std::pair<std::string, std::string>> remarks() const;
  /// Empty where none is given.
  GroundHeights heights() const;
};

/// Of a CSV file, OpenCRG or a grid. @param across false: the cut at place.v alone, alike for all y
/// @throws Error(bad_input) naming the file, the line and what was expected
GroundShape read_shape(const std::filesystem::path& file, const RoadPlace& place, bool across);

}  // namespace furrow::terrain
