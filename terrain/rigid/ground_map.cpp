#include "terrain/rigid/ground_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "protocol/core/assert.hpp"

namespace furrow::terrain {
namespace {

constexpr int kMostParts = 8;         // of a side of a triangle
constexpr int kMostFieldCells = 200;  // of a picture, along its longer side
constexpr int kMeanPoints = 16;       // of a mean, along each side
constexpr std::size_t kUnknown = std::numeric_limits<std::size_t>::max();
static_assert(kMostParts * kMostParts * kMaxGroundPoints <= std::tuple_size_v<ProfilePointList>);

/// Number of the interval that x lies in, and the share of it.
std::pair<std::size_t, double> interval(const std::vector<double>& nodes, double x) {
  const auto next = std::upper_bound(nodes.begin() + 1, nodes.end() - 1, x);
  const auto k = static_cast<std::size_t>(next - nodes.begin()) - 1;
  return {k, std::clamp((x - nodes[k]) / (nodes[k + 1] - nodes[k]), 0.0, 1.0)};
}

/// First and last node between two places, with those beside them.
std::pair<std::size_t, std::size_t> range(const std::vector<double>& nodes, double from, double to) {
  return {interval(nodes, from).first, interval(nodes, to).first + 1};
}

}  // namespace

std::array<double, 4> extent(const HeightMap& map) {
  if (!map.line) return {map.x.front(), map.x.back(), map.y.front(), map.y.back()};
  Eigen::AlignedBox2d box;
  for (std::size_t k = 0; k < map.line->points(); ++k)
    for (const double v : {map.y.front(), map.y.back()}) box.extend(map.line->beside(k, v));
  return {box.min().x(), box.max().x(), box.min().y(), box.max().y()};
}

GroundMap::GroundMap(HeightMap map) : map_(std::move(map)) {
  FURROW_ASSERT(map_.x.size() > 1 && map_.y.size() > 1, map_.x.size(), map_.y.size());
  FURROW_ASSERT(map_.z.size() == map_.x.size() * map_.y.size(), map_.z.size());
  top_ = *std::max_element(map_.z.begin(), map_.z.end());
}

RoadLine::Place GroundMap::place(double x, double y, std::size_t near) const {
  if (map_.line) return map_.line->place({x, y}, near);
  return {.u = x, .v = y};
}

GroundMap::Cell GroundMap::cell_at(const RoadLine::Place& at) const {
  const double x = at.u, y = at.v;
  const auto [ix, sx] = interval(map_.x, x);
  const auto [iy, sy] = interval(map_.y, y);
  return {ix, iy, sx, sy, x > map_.x.front() && x<map_.x.back(), y> map_.y.front() && y < map_.y.back()};
}

double GroundMap::height(double x, double y) const { return height(place(x, y, kUnknown)); }

double GroundMap::cosine(double x, double y) const { return cosine(place(x, y, kUnknown)); }

double GroundMap::height(const RoadLine::Place& place) const {
  const Cell c = cell_at(place);
  const double right = at(c.ix, c.iy) + c.sx * (at(c.ix + 1, c.iy) - at(c.ix, c.iy));
  const double left = at(c.ix, c.iy + 1) + c.sx * (at(c.ix + 1, c.iy + 1) - at(c.ix, c.iy + 1));
  return right + c.sy * (left - right);
}

double GroundMap::cosine(const RoadLine::Place& place) const {
  const Cell c = cell_at(place);
  const double z = at(c.ix, c.iy), ahead = at(c.ix + 1, c.iy), left = at(c.ix, c.iy + 1), both = at(c.ix + 1, c.iy + 1);
  const double dx = map_.x[c.ix + 1] - map_.x[c.ix], dy = map_.y[c.iy + 1] - map_.y[c.iy];
  const double h_x = c.inside_x ? ((1.0 - c.sy) * (ahead - z) + c.sy * (both - left)) / dx : 0.0;
  const double h_y = c.inside_y ? ((1.0 - c.sx) * (left - z) + c.sx * (both - ahead)) / dy : 0.0;
  if (!map_.line) return 1.0 / std::sqrt(1.0 + h_x * h_x + h_y * h_y);
  return 1.0 / std::sqrt(1.0 + (h_x * place.along + h_y * place.across).squaredNorm());
}

/// Of the grid under a part of the plane with these corners. Between them a line that turns bulges by less than their
/// distance² × its curvature / 8.
GroundMap::Range GroundMap::range_of(std::span<const RoadLine::Place> corners) const {
  Range range{corners[0].u, corners[0].u, corners[0].v, corners[0].v};
  for (const RoadLine::Place& corner : corners) {
    range.x_from = std::min(range.x_from, corner.u), range.x_to = std::max(range.x_to, corner.u);
    range.y_from = std::min(range.y_from, corner.v), range.y_to = std::max(range.y_to, corner.v);
  }
  if (!map_.line) return range;
  const double dx = range.x_to - range.x_from, dy = range.y_to - range.y_from;
  const double bulge = 0.125 * map_.line->most_curvature() * (dx * dx + dy * dy);
  return {range.x_from - bulge, range.x_to + bulge, range.y_from - bulge, range.y_to + bulge};
}

double GroundMap::depth(const Vec3& at) const {
  return std::max(0.0, height(at.x(), at.y()) - at.z()) * cosine(at.x(), at.y());
}

double GroundMap::highest(double x_from, double x_to, double y_from, double y_to) const {
  return highest(range_of(std::array{place(x_from, y_from, kUnknown), place(x_from, y_to, kUnknown),
                                     place(x_to, y_from, kUnknown), place(x_to, y_to, kUnknown)}));
}

double GroundMap::highest(const Range& in) const {
  const auto at = [&](double x, double y) { return height(RoadLine::Place{.u = x, .v = y}); };
  double top =
      std::max({at(in.x_from, in.y_from), at(in.x_from, in.y_to), at(in.x_to, in.y_from), at(in.x_to, in.y_to)});
  const auto [x_first, x_last] = range(map_.x, in.x_from, in.x_to);
  const auto [y_first, y_last] = range(map_.y, in.y_from, in.y_to);
  // Between the nodes inside and the sides of the rectangle heights are highest where a grid line meets a side.
  for (std::size_t ix = x_first; ix <= x_last; ++ix)
    for (std::size_t iy = y_first; iy <= y_last; ++iy)
      top = std::max(top, at(std::clamp(map_.x[ix], in.x_from, in.x_to), std::clamp(map_.y[iy], in.y_from, in.y_to)));
  return top;
}

double GroundMap::mean(double x_from, double x_to, double y_from, double y_to) const {
  FURROW_ASSERT(x_from <= x_to && y_from <= y_to, x_from, x_to, y_from, y_to);
  double sum = 0.0;
  for (int i = 0; i < kMeanPoints; ++i)
    for (int j = 0; j < kMeanPoints; ++j)
      sum += height(x_from + (i + 0.5) / kMeanPoints * (x_to - x_from),
                    y_from + (j + 0.5) / kMeanPoints * (y_to - y_from));
  return sum / (kMeanPoints * kMeanPoints);
}

HeightField GroundMap::field() const {
  const auto [x_from, x_to, y_from, y_to] = extent(map_);
  const double length = x_to - x_from, width = y_to - y_from;
  HeightField field;
  field.cell = std::max(length, width) / kMostFieldCells;
  field.nx = std::max(1, static_cast<std::int32_t>(std::lround(length / field.cell)));
  field.ny = std::max(1, static_cast<std::int32_t>(std::lround(width / field.cell)));
  field.x0 = x_from + 0.5 * field.cell;
  field.y0 = y_from + 0.5 * field.cell;
  for (int i = 0; i < field.nx; ++i)
    for (int j = 0; j < field.ny; ++j)
      field.height.push_back(height(field.x0 + i * field.cell, field.y0 + j * field.cell));
  return field;
}

int GroundMap::points(const std::array<Vec3, 3>& x, ProfilePointList& out) const {
  const double lowest = std::min({x[0].z(), x[1].z(), x[2].z()});
  if (!(top_ > lowest)) return 0;
  const RoadLine::Place first = place(x[0].x(), x[0].y(), kUnknown);
  const Range under =
      range_of(std::array{first, place(x[1].x(), x[1].y(), first.segment), place(x[2].x(), x[2].y(), first.segment)});
  if (!(highest(under) > lowest)) return 0;
  const auto [x_first, x_last] = range(map_.x, under.x_from, under.x_to);
  const auto [y_first, y_last] = range(map_.y, under.y_from, under.y_to);
  const int parts = std::clamp(static_cast<int>(std::max(x_last - x_first, y_last - y_first)), 1, kMostParts);
  const double area = 0.5 * (x[1] - x[0]).cross(x[2] - x[0]).norm() / (parts * parts);

  std::array<double, 45> gap;  // of the corners of the parts above the ground, m
  static_assert((kMostParts + 1) * (kMostParts + 2) / 2 == std::tuple_size_v<decltype(gap)>);
  const auto row = [&](int i) { return i * (parts + 1) - i * (i - 1) / 2; };
  for (int i = 0; i <= parts; ++i)
    for (int j = 0; i + j <= parts; ++j) {
      const double a = static_cast<double>(i) / parts, b = static_cast<double>(j) / parts;
      const Vec3 p = (1.0 - a - b) * x[0] + a * x[1] + b * x[2];
      gap[row(i) + j] = p.z() - height(place(p.x(), p.y(), first.segment));
    }
  int count = 0;
  std::array<GroundPoint, kMaxGroundPoints> own;
  const auto take = [&](const std::array<std::pair<int, int>, 3>& corner) {
    std::array<double, 3> z{};
    for (int k = 0; k < 3; ++k) z[k] = gap[row(corner[k].first) + corner[k].second];
    if (z[0] >= 0.0 && z[1] >= 0.0 && z[2] >= 0.0) return;
    // In the plane of the triangle, where a part has the area ½.
    const int found = ground_points({Vec3(0.0, 0.0, z[0]), Vec3(1.0, 0.0, z[1]), Vec3(0.0, 1.0, z[2])}, own);
    for (int q = 0; q < found; ++q) {
      double a = 0.0, b = 0.0;
      for (int k = 0; k < 3; ++k) a += own[q].weight[k] * corner[k].first, b += own[q].weight[k] * corner[k].second;
      a /= parts, b /= parts;
      GroundPoint point;
      point.weight = {1.0 - a - b, a, b};
      const Vec3 p = point.weight[0] * x[0] + a * x[1] + b * x[2];
      point.cosine = cosine(place(p.x(), p.y(), first.segment));
      point.depth = own[q].depth * point.cosine;
      point.area = 2.0 * own[q].area * area;
      point.level = false;
      out[count++] = point;
    }
  };
  for (int i = 0; i < parts; ++i)
    for (int j = 0; i + j < parts; ++j) {
      take({{{i, j}, {i + 1, j}, {i, j + 1}}});
      if (i + j + 1 < parts) take({{{i + 1, j}, {i + 1, j + 1}, {i, j + 1}}});
    }
  return count;
}

}  // namespace furrow::terrain
