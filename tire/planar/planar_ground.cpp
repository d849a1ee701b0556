#include "tire/planar/planar_ground.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "protocol/core/assert.hpp"

namespace furrow::tire {
namespace {

constexpr double kFar = 4.0;   // radii to which plates reach
constexpr double kDeep = 100;  // of a bar's sides, m: larger than any tire

bool by_x(const PlanarPoint& a, const PlanarPoint& b) { return a.x < b.x; }

}  // namespace

PlanarGround::PlanarGround(std::vector<PlanarPoint> points) : points_(std::move(points)) {
  FURROW_ASSERT(points_.size() >= 2, points_.size());
  top_ = points_.front().z;
  for (std::size_t k = 0; k < points_.size(); ++k) {
    const PlanarPoint& p = points_[k];
    FURROW_ASSERT(std::isfinite(p.x) && std::isfinite(p.z), k, p.x, p.z);
    top_ = std::max(top_, p.z);
    if (k == 0) continue;
    const PlanarPoint& a = points_[k - 1];
    FURROW_ASSERT(a.x <= p.x && (a.x < p.x || a.z != p.z), k, a.x, p.x);
  }
  corners_.push_back(points_.front());
  for (std::size_t k = 1; k + 1 < points_.size(); ++k) {
    const PlanarPoint &a = points_[k - 1], &b = points_[k], &c = points_[k + 1];
    if ((b.x - a.x) * (c.z - b.z) - (b.z - a.z) * (c.x - b.x) < 0.0) corners_.push_back(b);
  }
  corners_.push_back(points_.back());
}

PlanarGround PlanarGround::plate(double radius) { return PlanarGround({{-kFar * radius, 0.0}, {kFar * radius, 0.0}}); }

PlanarGround PlanarGround::bar(double width, double position) {
  FURROW_ASSERT(width > 0.0, width);
  const double left = position - 0.5 * width, right = position + 0.5 * width;
  return PlanarGround({{left, -kDeep}, {left, 0.0}, {right, 0.0}, {right, -kDeep}});
}

PlanarGround PlanarGround::curb(double height, double length) {
  return PlanarGround({{-length, 0.0}, {0.0, 0.0}, {0.0, height}, {length, height}});
}

/// The solid's height at x; at a vertical face, its highest. −∞ beyond the ends.
double PlanarGround::height(double x) const {
  constexpr double kNone = -std::numeric_limits<double>::infinity();
  if (x < points_.front().x || x > points_.back().x) return kNone;
  auto right = std::lower_bound(points_.begin(), points_.end(), PlanarPoint{x, 0.0}, by_x);
  double top = kNone;
  for (auto p = right; p != points_.end() && p->x == x; ++p) top = std::max(top, p->z);
  if (right->x == x) return top;
  const PlanarPoint &b = *right, &a = *(right - 1);
  return a.z + (b.z - a.z) * (x - a.x) / (b.x - a.x);
}

// The nearest side is at most as far as the side straight above, so only faces within that distance in x are checked.
PlanarDepth PlanarGround::depth(double x, double z) const {
  const double above = height(x) - z;
  if (!(above > 0.0)) return {};
  PlanarDepth found{above, 0.0, 1.0};
  auto last = std::lower_bound(points_.begin(), points_.end(), PlanarPoint{x - above, 0.0}, by_x);
  if (last == points_.begin()) ++last;
  for (; last != points_.end() && (last - 1)->x <= x + found.depth; ++last) {
    const PlanarPoint &a = *(last - 1), &b = *last;
    const double dx = b.x - a.x, dz = b.z - a.z;
    const double share = std::clamp(((x - a.x) * dx + (z - a.z) * dz) / (dx * dx + dz * dz), 0.0, 1.0);
    const double to_x = a.x + share * dx - x, to_z = a.z + share * dz - z, distance = std::hypot(to_x, to_z);
    if (distance < found.depth && distance > 0.0) found = {distance, to_x / distance, to_z / distance};
  }
  return found;
}

}  // namespace furrow::tire
