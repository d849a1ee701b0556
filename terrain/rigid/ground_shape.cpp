#include "terrain/rigid/ground_shape.hpp"

#include <fmt/format.h>

#include "terrain/rigid/ground_map.hpp"
#include "terrain/rigid/roads/read_map.hpp"
#include "terrain/rigid/roads/read_road.hpp"

namespace furrow::terrain {
namespace {

constexpr double kStraight = 0.02;  // rad: a metre in fifty

}  // namespace

UnevenPart GroundShape::uneven() const {
  if (map) return {map->x.front(), map->x.back(), map->y.front(), map->y.back()};
  UnevenPart part;
  if (const auto [from, to] = uneven_range(profile); from <= to) part.from = from, part.to = to;
  return part;
}

std::vector<std::pair<std::string, std::string>> GroundShape::remarks() const {
  if (!map || !(map->turn > kStraight)) return {};
  return {{"profile_file",
           fmt::format("has a reference line that turns by {:.2g} rad: it is laid straight along x, its curves are not "
                       "driven",
                       map->turn)}};
}

GroundHeights GroundShape::heights() const {
  if (!given()) return {};
  if (map) return [ground = GroundMap(*map)](double x, double y) { return ground.height(x, y); };
  return [ground = GroundProfile(profile)](double x, double) { return ground.height(x); };
}

GroundShape read_shape(const std::filesystem::path& file, const RoadPlace& place, bool across) {
  GroundShape shape;
  if (across) shape.map = read_map(file, place);
  if (!shape.map) shape.profile = read_road(file, place);
  return shape;
}

}  // namespace furrow::terrain
