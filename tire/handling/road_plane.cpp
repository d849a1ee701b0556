#include "tire/handling/road_plane.hpp"

#include <array>
#include <cmath>
#include <utility>

#include "protocol/core/assert.hpp"

namespace furrow::tire::handling {
namespace {

constexpr std::array<double, 5> kAlong{1.0 / 12, 4.0 / 12, 2.0 / 12, 4.0 / 12, 1.0 / 12};  // Simpson's weights
constexpr std::array<double, 3> kAcross{1.0 / 6, 4.0 / 6, 1.0 / 6};
constexpr int kMostRounds = 20;
constexpr double kSettled = 1e-9;  // between two contact centres, of the radius

}  // namespace

RoadPlane::RoadPlane(GroundHeights heights, double half_length, double half_width)
    : heights_(std::move(heights)), half_length_(half_length), half_width_(half_width) {
  FURROW_ASSERT(half_length > 0.0 && half_width > 0.0, half_length, half_width);
}

GroundPlane RoadPlane::at(double x, double y, const Vec3& along) const {
  const Vec3 across(-along.y(), along.x(), 0.0);
  double mean = 0.0, rise_along = 0.0, rise_across = 0.0;
  for (std::size_t i = 0; i < kAlong.size(); ++i)
    for (std::size_t j = 0; j < kAcross.size(); ++j) {
      const double xi = half_length_ * (0.5 * static_cast<double>(i) - 1.0),
                   eta = half_width_ * (static_cast<double>(j) - 1.0);
      const double h = heights_(x + xi * along.x() + eta * across.x(), y + xi * along.y() + eta * across.y());
      mean += kAlong[i] * kAcross[j] * h;
      if (i == 0 || i + 1 == kAlong.size()) rise_along += (i == 0 ? -1.0 : 1.0) * kAcross[j] * h;
      if (j == 0 || j + 1 == kAcross.size()) rise_across += (j == 0 ? -1.0 : 1.0) * kAlong[i] * h;
    }
  const Vec3 slope = rise_along / (2.0 * half_length_) * along + rise_across / (2.0 * half_width_) * across;
  return {{x, y, mean}, Vec3(-slope.x(), -slope.y(), 1.0).normalized()};
}

WheelAxes RoadPlane::axes_of(const RimState& rim, const Vec3& travel, double radius) const {
  if (!heights_) return wheel_axes(rim, travel, 0.0);
  Vec3 centre = rim.position - radius * Vec3::UnitZ();
  WheelAxes axes;
  for (int round = 0; round < kMostRounds; ++round) {
    axes = wheel_axes(rim, travel, at(centre.x(), centre.y(), travel));
    const double off = (axes.origin - centre).head<2>().norm();
    centre = axes.origin;
    if (off < kSettled * radius) break;
  }
  return axes;
}

}  // namespace furrow::tire::handling
