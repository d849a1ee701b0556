#include "terrain/rigid/roads/read_road.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "protocol/files/csv_file.hpp"
#include "terrain/rigid/ground_map.hpp"
#include "terrain/rigid/roads/open_crg.hpp"
#include "terrain/rigid/roads/read_map.hpp"

namespace furrow::terrain {
namespace {

ProfilePoints read_csv(const std::filesystem::path& file) {
  const CsvFile csv(file, "a profile in CSV with the columns x_m and z_m", {"x_m", "z_m"});
  ProfilePoints points;
  for (std::size_t row = 0; row < csv.row_count(); ++row) {
    std::array<double, 2> point;
    for (const auto& [name, value] : {std::pair("x_m", &point[0]), std::pair("z_m", &point[1])}) {
      *value = csv.number(row, name);
      if (std::abs(*value) > kFarthest)
        throw csv.wrong(row, fmt::format("{} is {:g}, expected {:g} to {:g}", name, *value, -kFarthest, kFarthest));
    }
    points.push_back(point);
    switch (fault_of(points, points.size() - 1)) {
      case ProfileFault::none:
        break;
      case ProfileFault::goes_back:
        throw csv.wrong(row, fmt::format("x_m is {:g}, expected {:g}, as in the row before, or more", point[0],
                                         points[points.size() - 2][0]));
      case ProfileFault::repeated:
        throw csv.wrong(row, "is the row before once more, expected another point");
      case ProfileFault::third_at_one_x:
        throw csv.wrong(row, fmt::format("x_m is {:g} a third time, expected two rows at most: the foot and the "
                                         "top of an upright face",
                                         point[0]));
    }
  }
  return points;
}

/// A grid cut along x at y = 0.
ProfilePoints cut(const HeightMap& map, const std::filesystem::path& file, const RoadPlace& place) {
  if (map.y.front() > 0.0 || map.y.back() < 0.0)
    throw input_error(file.string(), "",
                      fmt::format("has no height at y = {:g} m, expected terrain.profile_v from {:g} to {:g} m",
                                  place.v, place.v + map.y.front(), place.v + map.y.back()));
  const GroundMap ground(map);
  ProfilePoints points;
  for (const double x : map.x) points.push_back({x, ground.height(x, 0.0)});
  return points;
}

}  // namespace

ProfilePoints read_road(const std::filesystem::path& file, const RoadPlace& place) {
  ProfilePoints points;
  if (has_ending(file, ".crg"))
    points = profile_of(read_open_crg(file), place.v, file);
  else if (const auto map = read_map(file, place))
    points = cut(*map, file, place);
  else
    points = read_csv(file);
  if (points.size() > kMostProfilePoints)
    throw input_error(file.string(), "",
                      fmt::format("has {} points, expected at most {}", points.size(), kMostProfilePoints));
  const double shift = place.shift(points.front()[0]);
  for (auto& point : points) point[0] += shift;
  return points;
}

}  // namespace furrow::terrain
