#include "tire/ring/ring_ground.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "protocol/core/assert.hpp"

namespace furrow::tire {
namespace {

constexpr double kFlat = 1e-9;  // change of slope below which a point is not a corner

}  // namespace

RingGround::RingGround(std::vector<GroundPoint> points) : points_(std::move(points)) {
  FURROW_ASSERT(points_.size() >= 2, points_.size());
  top_ = points_.front().z;
  for (const GroundPoint& p : points_) top_ = std::max(top_, p.z);
  corners_.push_back(points_.front());
  for (int i = 1; i + 1 < static_cast<int>(points_.size()); ++i)
    if (slope(i) < slope(i - 1) - kFlat) corners_.push_back(points_[i]);
  corners_.push_back(points_.back());
}

RingGround RingGround::plate(double radius) { return RingGround({{-2.0 * radius, 0.0}, {2.0 * radius, 0.0}}); }

RingGround RingGround::bar(double width, double position) {
  return RingGround({{position - 0.5 * width, 0.0}, {position + 0.5 * width, 0.0}});
}

int RingGround::face(double x) const {
  if (!(x >= points_.front().x && x <= points_.back().x)) return -1;
  const auto after = std::upper_bound(points_.begin() + 1, points_.end() - 1, x,
                                      [](double at, const GroundPoint& p) { return at < p.x; });
  return static_cast<int>(after - points_.begin()) - 1;
}

double RingGround::slope(int face) const {
  const GroundPoint &a = points_[face], &b = points_[face + 1];
  return (b.z - a.z) / (b.x - a.x);
}

double RingGround::height(int face, double x) const { return points_[face].z + slope(face) * (x - points_[face].x); }

// The ray x + ρ sin θ, z − ρ cos θ meets the face's line where z − ρ cos θ = z_i + m (x + ρ sin θ − x_i).
double RingGround::distance(double x, double z, double angle) const {
  const double s = std::sin(angle), c = std::cos(angle);
  double nearest = std::numeric_limits<double>::infinity();
  for (int i = 0; i + 1 < static_cast<int>(points_.size()); ++i) {
    const double m = slope(i), towards = c + m * s;
    if (!(towards > 0.0)) continue;  // from below, or along it
    const double rho = (z - points_[i].z - m * (x - points_[i].x)) / towards, at = x + rho * s;
    if (at >= points_[i].x && at <= points_[i + 1].x && rho > 0.0) nearest = std::min(nearest, rho);
  }
  return nearest;
}

}  // namespace furrow::tire
