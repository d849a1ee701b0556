#include "terrain/rigid/ground_shape.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "protocol/core/error.hpp"
#include "terrain/rigid/ground_map.hpp"
#include "terrain/rigid/roads/read_map.hpp"
#include "terrain/rigid/roads/read_road.hpp"

namespace furrow::terrain {
namespace {

constexpr double kStraight = 0.02;  // rad: a metre in fifty
constexpr double kMostStep = 3.0;   // m, of what a wheel or a vehicle meets

}  // namespace

UnevenPart GroundShape::uneven() const {
  if (map) {
    const auto [from, to, right, left] = extent(*map);
    return {from, to, right, left};
  }
  UnevenPart part;
  if (const auto [from, to] = uneven_range(profile); from <= to) part.from = from, part.to = to;
  return part;
}

std::string GroundShape::range() const {
  if (map) {
    const auto [low, high] = std::ranges::minmax(map->z);
    return fmt::format(", heights from {:.4g} to {:.4g} m over {:.5g} m by {:.4g} m", low, high,
                       map->x.back() - map->x.front(), map->y.back() - map->y.front());
  }
  if (profile.empty()) return "";
  const auto [low, high] = std::ranges::minmax(profile, {}, [](const auto& point) { return point[1]; });
  return fmt::format(", heights from {:.4g} to {:.4g} m over {:.5g} m", low[1], high[1],
                     profile.back()[0] - profile.front()[0]);
}

std::vector<std::pair<std::string, std::string>> GroundShape::remarks() const {
  std::vector<std::pair<std::string, std::string>> found;
  if (map && map->turn > kStraight)
    found.emplace_back("profile_file",
                       fmt::format("has a reference line that turns by {:.2g} rad: it is laid straight along x; with "
                                   "terrain.profile_line curved it turns",
                                   map->turn));
  double rise = 0.0, at = 0.0;  // the largest step, m
  const auto look = [&](double x, double run, double step) {
    if (std::abs(step) > std::max(run, rise)) rise = std::abs(step), at = x;
  };
  for (std::size_t k = 1; k < profile.size(); ++k)
    look(profile[k][0], profile[k][0] - profile[k - 1][0], profile[k][1] - profile[k - 1][1]);
  const std::size_t across = map ? map->y.size() : 0;
  for (std::size_t k = across; map && k < map->z.size(); ++k)
    look(map->x[k / across], map->x[k / across] - map->x[k / across - 1], map->z[k] - map->z[k - across]);
  if (rise > kMostStep)
    found.emplace_back(
        "profile_file",
        fmt::format("steps by {:g} m at {} = {:g} m, expected lengths and heights in m: another unit, or degrees?",
                    rise, map && map->line ? "u" : "x", at));
  return found;
}

GroundHeights GroundShape::heights() const {
  if (!given()) return {};
  if (map) return [ground = GroundMap(*map)](double x, double y) { return ground.height(x, y); };
  return [ground = GroundProfile(profile)](double x, double) { return ground.height(x); };
}

GroundShape read_shape(const std::filesystem::path& file, const RoadPlace& place, bool across) {
  if (place.curved && !across)
    throw input_error(file.string(), "",
                      "is read along its reference line (terrain.profile_line curved), expected terrain.profile_across "
                      "true");
  GroundShape shape;
  if (across) shape.map = read_map(file, place);
  if (!shape.map) shape.profile = read_road(file, place);
  return shape;
}

}  // namespace furrow::terrain
