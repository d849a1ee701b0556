#include "terrain/rigid/roads/read_road.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "protocol/files/csv_file.hpp"
#include "terrain/rigid/roads/open_crg.hpp"

namespace furrow::terrain {
namespace {

constexpr double kFarthest = 1e6;  // m, as entries of terrain.profile

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

/// By the ending, in any case.
bool is_open_crg(const std::filesystem::path& file) {
  std::string end = file.extension().string();
  std::transform(end.begin(), end.end(), end.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
  return end == ".crg";
}

}  // namespace

ProfilePoints read_road(const std::filesystem::path& file, double v) {
  const ProfilePoints points = is_open_crg(file) ? profile_of(read_open_crg(file), v, file) : read_csv(file);
  if (points.size() > kMostProfilePoints)
    throw input_error(file.string(), "",
                      fmt::format("has {} points, expected at most {}", points.size(), kMostProfilePoints));
  return points;
}

}  // namespace furrow::terrain
