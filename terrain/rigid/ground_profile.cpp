#include "terrain/rigid/ground_profile.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"

namespace furrow::terrain {
namespace {

// Gauss and Legendre's rule of four points on (0, 1).
constexpr std::array<double, 4> kAt{0.0694318442029737, 0.3300094782075719, 0.6699905217924281, 0.9305681557970263};
constexpr std::array<double, 4> kWeight{0.1739274225687269, 0.3260725774312731, 0.3260725774312731, 0.1739274225687269};

bool before(const std::array<double, 2>& point, double x) { return point[0] < x; }

}  // namespace

ProfileFault fault_of(const ProfilePoints& points, std::size_t last) {
  FURROW_ASSERT(last < points.size(), last, points.size());
  if (last == 0) return ProfileFault::none;
  const auto &a = points[last - 1], &b = points[last];
  if (b[0] < a[0]) return ProfileFault::goes_back;
  if (b == a) return ProfileFault::repeated;
  if (last > 1 && b[0] == points[last - 2][0]) return ProfileFault::third_at_one_x;
  return ProfileFault::none;
}

void check_profile(const ProfilePoints& points, const std::string& file, const std::string& key) {
  for (std::size_t k = 1; k < points.size(); ++k) {
    const auto &a = points[k - 1], &b = points[k];
    const std::string here = fmt::format("{}.{}", key, k);
    switch (fault_of(points, k)) {
      case ProfileFault::none:
        break;
      case ProfileFault::goes_back:
        throw input_error(file, here + ".0",
                          fmt::format("is {:g} m, expected {:g} m, as in the entry before, or more", b[0], a[0]));
      case ProfileFault::repeated:
        throw input_error(file, here,
                          fmt::format("is [{:g}, {:g}] m as the entry before, expected another point", b[0], b[1]));
      case ProfileFault::third_at_one_x:
        throw input_error(file, here + ".0",
                          fmt::format("is {:g} m a third time, expected two entries at most: the foot and the top "
                                      "of an upright face",
                                      b[0]));
    }
  }
}

std::array<double, 2> uneven_range(const ProfilePoints& points) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  std::array<double, 2> range{kNaN, kNaN};
  for (std::size_t k = 1; k < points.size(); ++k) {
    if (points[k][1] == points[k - 1][1]) continue;
    if (std::isnan(range[0])) range[0] = points[k - 1][0];
    range[1] = points[k][0];
  }
  return range;
}

GroundProfile::GroundProfile(const ProfilePoints& points) : points_(points) {
  if (points_.empty()) points_.push_back({0.0, 0.0});
}

std::size_t GroundProfile::first_at(double x) const {
  return static_cast<std::size_t>(std::lower_bound(points_.begin(), points_.end(), x, before) - points_.begin());
}

double GroundProfile::height(double x) const {
  std::size_t right = first_at(x);
  if (right == points_.size()) return points_.back()[1];
  if (points_[right][0] == x) {
    double top = points_[right][1];
    for (; right < points_.size() && points_[right][0] == x; ++right) top = std::max(top, points_[right][1]);
    return top;
  }
  if (right == 0) return points_.front()[1];
  const auto &a = points_[right - 1], &b = points_[right];
  return a[1] + (b[1] - a[1]) * (x - a[0]) / (b[0] - a[0]);
}

double GroundProfile::highest(double from, double to) const {
  double top = std::max(height(from), height(to));
  for (std::size_t k = first_at(from); k < points_.size() && points_[k][0] <= to; ++k)
    top = std::max(top, points_[k][1]);
  return top;
}

double GroundProfile::mean(double from, double to) const {
  FURROW_ASSERT(from <= to, from, to);
  if (from == to) return height(from);
  double area = 0.0, x = from, z = height(from);
  for (std::size_t k = first_at(from); k < points_.size() && points_[k][0] < to; ++k) {
    area += 0.5 * (z + points_[k][1]) * (points_[k][0] - x);
    x = points_[k][0], z = points_[k][1];
  }
  // An upright face at the end counts by neither of its heights: it has no width.
  const double end = points_.empty() || to > points_.back()[0] ? points_.back()[1] : height(to);
  return (area + 0.5 * (z + end) * (to - x)) / (to - from);
}

/// To the skin, at most `most`: no farther along x is looked for.
double GroundProfile::distance(double x, double z, double most) const {
  double found = most;
  if (x - found <= points_.front()[0] && std::abs(z - points_.front()[1]) < found)
    found = x <= points_.front()[0] ? std::abs(z - points_.front()[1])
                                    : std::min(found, std::hypot(x - points_.front()[0], z - points_.front()[1]));
  if (x + found >= points_.back()[0] && std::abs(z - points_.back()[1]) < found)
    found = x >= points_.back()[0] ? std::min(found, std::abs(z - points_.back()[1]))
                                   : std::min(found, std::hypot(x - points_.back()[0], z - points_.back()[1]));
  for (std::size_t k = std::max<std::size_t>(1, first_at(x - most)); k < points_.size(); ++k) {
    const auto &a = points_[k - 1], &b = points_[k];
    if (a[0] > x + found) break;
    const double dx = b[0] - a[0], dz = b[1] - a[1];
    const double share = std::clamp(((x - a[0]) * dx + (z - a[1]) * dz) / (dx * dx + dz * dz), 0.0, 1.0);
    found = std::min(found, std::hypot(a[0] + share * dx - x, a[1] + share * dz - z));
  }
  return found;
}

double GroundProfile::depth(double x, double z) const {
  const double above = height(x) - z;
  return above > 0.0 ? distance(x, z, above) : 0.0;
}

double GroundProfile::column(double x, double z) const {
  const double above = height(x) - z;
  if (!(above > 0.0)) return 0.0;
  double sum = 0.0;
  for (std::size_t q = 0; q < kAt.size(); ++q) sum += kWeight[q] * depth(x, z + kAt[q] * above);
  return sum * above;
}

bool GroundProfile::level(double from, double to, double deep) const {
  const double left = from - deep, right = to + deep;
  const std::size_t k = first_at(left);
  if (k == points_.size() || points_[k][0] > right) {  // no corner: before, between or after
    return k == 0 || k == points_.size() || points_[k - 1][1] == points_[k][1];
  }
  const double z = points_[k][1];
  if (k > 0 && points_[k - 1][1] != z) return false;
  std::size_t last = k;
  for (; last < points_.size() && points_[last][0] <= right; ++last)
    if (points_[last][1] != z) return false;
  return last == points_.size() || points_[last][1] == z;
}

}  // namespace furrow::terrain
