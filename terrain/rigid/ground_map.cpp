#include "terrain/rigid/ground_map.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "protocol/core/assert.hpp"

namespace furrow::terrain {
namespace {

constexpr int kMostParts = 8;         // of a side of a triangle
constexpr int kMostFieldCells = 200;  // of a picture, along its longer side
constexpr int kMeanPoints = 16;       // of a mean, along each side
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

GroundMap::GroundMap(HeightMap map) : map_(std::move(map)) {
  FURROW_ASSERT(map_.x.size() > 1 && map_.y.size() > 1, map_.x.size(), map_.y.size());
  FURROW_ASSERT(map_.z.size() == map_.x.size() * map_.y.size(), map_.z.size());
  top_ = *std::max_element(map_.z.begin(), map_.z.end());
}

GroundMap::Cell GroundMap::cell_at(double x, double y) const {
  const auto [ix, sx] = interval(map_.x, x);
  const auto [iy, sy] = interval(map_.y, y);
  return {ix, iy, sx, sy, x > map_.x.front() && x<map_.x.back(), y> map_.y.front() && y < map_.y.back()};
}

double GroundMap::height(double x, double y) const {
  const Cell c = cell_at(x, y);
  const double right = at(c.ix, c.iy) + c.sx * (at(c.ix + 1, c.iy) - at(c.ix, c.iy));
  const double left = at(c.ix, c.iy + 1) + c.sx * (at(c.ix + 1, c.iy + 1) - at(c.ix, c.iy + 1));
  return right + c.sy * (left - right);
}

double GroundMap::cosine(double x, double y) const {
  const Cell c = cell_at(x, y);
  const double z = at(c.ix, c.iy), ahead = at(c.ix + 1, c.iy), left = at(c.ix, c.iy + 1), both = at(c.ix + 1, c.iy + 1);
  const double dx = map_.x[c.ix + 1] - map_.x[c.ix], dy = map_.y[c.iy + 1] - map_.y[c.iy];
  const double h_x = c.inside_x ? ((1.0 - c.sy) * (ahead - z) + c.sy * (both - left)) / dx : 0.0;
  const double h_y = c.inside_y ? ((1.0 - c.sx) * (left - z) + c.sx * (both - ahead)) / dy : 0.0;
  return 1.0 / std::sqrt(1.0 + h_x * h_x + h_y * h_y);
}

double GroundMap::depth(const Vec3& at) const {
  return std::max(0.0, height(at.x(), at.y()) - at.z()) * cosine(at.x(), at.y());
}

double GroundMap::highest(double x_from, double x_to, double y_from, double y_to) const {
  double top = std::max({height(x_from, y_from), height(x_from, y_to), height(x_to, y_from), height(x_to, y_to)});
  const auto [x_first, x_last] = range(map_.x, x_from, x_to);
  const auto [y_first, y_last] = range(map_.y, y_from, y_to);
  // Between the nodes inside and the sides of the rectangle heights are highest where a grid line meets a side.
  for (std::size_t ix = x_first; ix <= x_last; ++ix)
    for (std::size_t iy = y_first; iy <= y_last; ++iy)
      top = std::max(top, height(std::clamp(map_.x[ix], x_from, x_to), std::clamp(map_.y[iy], y_from, y_to)));
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
  const double length = map_.x.back() - map_.x.front(), width = map_.y.back() - map_.y.front();
  HeightField field;
  field.cell = std::max(length, width) / kMostFieldCells;
  field.nx = std::max(1, static_cast<std::int32_t>(std::lround(length / field.cell)));
  field.ny = std::max(1, static_cast<std::int32_t>(std::lround(width / field.cell)));
  field.x0 = map_.x.front() + 0.5 * field.cell;
  field.y0 = map_.y.front() + 0.5 * field.cell;
  for (int i = 0; i < field.nx; ++i)
    for (int j = 0; j < field.ny; ++j)
      field.height.push_back(height(field.x0 + i * field.cell, field.y0 + j * field.cell));
  return field;
}

int GroundMap::points(const std::array<Vec3, 3>& x, ProfilePointList& out) const {
  const double lowest = std::min({x[0].z(), x[1].z(), x[2].z()});
  if (!(top_ > lowest)) return 0;
  const auto [x_from, x_to] = std::minmax({x[0].x(), x[1].x(), x[2].x()});
  const auto [y_from, y_to] = std::minmax({x[0].y(), x[1].y(), x[2].y()});
  if (!(highest(x_from, x_to, y_from, y_to) > lowest)) return 0;
  const auto [x_first, x_last] = range(map_.x, x_from, x_to);
  const auto [y_first, y_last] = range(map_.y, y_from, y_to);
  const int parts = std::clamp(static_cast<int>(std::max(x_last - x_first, y_last - y_first)), 1, kMostParts);
  const double area = 0.5 * (x[1] - x[0]).cross(x[2] - x[0]).norm() / (parts * parts);

  std::array<double, 45> gap;  // of the corners of the parts above the ground, m
  static_assert((kMostParts + 1) * (kMostParts + 2) / 2 == std::tuple_size_v<decltype(gap)>);
  const auto row = [&](int i) { return i * (parts + 1) - i * (i - 1) / 2; };
  for (int i = 0; i <= parts; ++i)
    for (int j = 0; i + j <= parts; ++j) {
      const double a = static_cast<double>(i) / parts, b = static_cast<double>(j) / parts;
      const Vec3 p = (1.0 - a - b) * x[0] + a * x[1] + b * x[2];
      gap[row(i) + j] = p.z() - height(p.x(), p.y());
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
      point.cosine = cosine(p.x(), p.y());
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
