// Height maps of hard ground from files: OpenCRG (.crg), grids in ASCII after ESRI (.asc) and CSV with the columns x_m,
// y_m and z_m, one row for each node of a grid, in any order.
//
// Esri, ArcGIS Desktop, "Esri ASCII raster format": ncols, nrows, xllcorner or xllcenter, yllcorner or yllcenter,
// cellsize and NODATA_value, then the heights of the cells' centres, rows from north (largest y) to south.
#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

#include "terrain/rigid/roads/road_place.hpp"

namespace furrow::terrain {

struct HeightMap;

inline constexpr std::size_t kMostMapNodes = 50'000'000;

/// Whether the name ends so, in any case. @param ending in small letters
bool has_ending(const std::filesystem::path& file, std::string_view ending);

/// Where OpenCRG has no height at the end of a cross-section, that beside it is taken.
/// @returns null where the file is a profile, alike for all y
/// @throws Error(bad_input) naming the file, the line and what was expected
std::shared_ptr<const HeightMap> read_map(const std::filesystem::path& file, const RoadPlace& place);

}  // namespace furrow::terrain
