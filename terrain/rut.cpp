#include "terrain/rut.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "protocol/core/assert.hpp"

namespace furrow::terrain {
namespace {

constexpr double kNearest = 0.642, kFarthest = 1.177;  // undeformed radii behind the axle

/// Mean of before − after along travel, per y cell.
std::vector<double> transverse_profile(const HeightField& before, const HeightField& after, double x_min,
                                       double x_max) {
  std::vector<double> profile(after.ny, NAN);
  for (int iy = 0; iy < after.ny; ++iy) {
    double sum = 0.0;
    int count = 0;
    for (int ix = 0; ix < after.nx; ++ix) {
      const double x = after.x0 + ix * after.cell;
      const double depth = before.height[ix * after.ny + iy] - after.height[ix * after.ny + iy];
      if (x < x_min || x > x_max || !std::isfinite(depth)) continue;
      sum += depth;
      ++count;
    }
    if (count > 0) profile[iy] = sum / count;
  }
  return profile;
}

/// Mean of before − after over the cells within `half_width` of the wheel's plane, for each row of cells along the
/// travel; rows without grains are left out.
std::vector<double> profile_along(const HeightField& before, const HeightField& after, double x_min, double x_max,
                                  double lateral, double half_width) {
  std::vector<double> along;
  for (int ix = 0; ix < after.nx; ++ix) {
    const double x = after.x0 + ix * after.cell;
    if (x < x_min || x > x_max) continue;
    double sum = 0.0;
    int count = 0;
    for (int iy = 0; iy < after.ny; ++iy) {
      const double depth = before.height[ix * after.ny + iy] - after.height[ix * after.ny + iy];
      if (std::abs(after.y0 + iy * after.cell - lateral) > half_width || !std::isfinite(depth)) continue;
      sum += depth;
      ++count;
    }
    if (count > 0) along.push_back(sum / count);
  }
  return along;
}

/// Position where the profile falls below `level` for two cells or more, going from cell `from` in steps of `step`;
/// linear between cells. Cells without grains are skipped; the search ends at the bin's edge.
double crossing(const std::vector<double>& y, const std::vector<double>& profile, int from, int step, double level) {
  FURROW_ASSERT(y.size() == profile.size() && in_range(from, y.size()), y.size(), profile.size(), from);
  FURROW_ASSERT(step == 1 || step == -1, step);
  const int count = static_cast<int>(y.size());
  const auto inside = [count](int i) { return i >= 0 && i < count; };
  const auto below = [&](int i) { return !inside(i) || !(profile[i] >= level); };
  int last = from;  // the last cell seen at or above the level
  for (int i = from; inside(i); i += step) {
    if (!std::isfinite(profile[i])) continue;
    if (profile[i] >= level) {
      last = i;
    } else if (below(i + step)) {
      if (!(profile[last] >= level)) return y[i];
      return y[last] + (y[i] - y[last]) * (profile[last] - level) / (profile[last] - profile[i]);
    }
  }
  return step > 0 ? y.back() : y.front();
}

/// Why there is no rut to measure, in words; empty if there may be one.
std::string why_not(const HeightField& before, const HeightField& after, const RutOptions& o) {
  if (after.nx <= 0 || after.ny <= 0) return "the ground keeps no rut";
  if (before.nx != after.nx || before.ny != after.ny) return "the surface before the run is not known";
  const double travelled = o.direction * (o.axle - o.start), farthest = kFarthest * o.radius;
  if (travelled >= farthest) return "";
  return fmt::format("the axle travelled {:.3g} m, and the rut is measured {:.3g} to {:.3g} m behind it", travelled,
                     kNearest * o.radius, farthest);
}

}  // namespace

Rut measure_rut(const HeightField& before, const HeightField& after, const RutOptions& o) {
  FURROW_ASSERT(std::abs(o.direction) == 1.0 && o.radius > 0.0, o.direction, o.radius);
  FURROW_ASSERT(before.height.size() == static_cast<std::size_t>(before.nx) * before.ny, before.height.size(),
                before.nx, before.ny);
  FURROW_ASSERT(after.height.size() == static_cast<std::size_t>(after.nx) * after.ny, after.height.size(), after.nx,
                after.ny);
  Rut rut;
  rut.missing = why_not(before, after, o);
  if (!rut.missing.empty()) return rut;
  const double a = o.axle - o.direction * kNearest * o.radius, b = o.axle - o.direction * kFarthest * o.radius;
  const double middle_half = 0.25 * o.tread_width;
  rut.profile = transverse_profile(before, after, std::min(a, b), std::max(a, b));
  rut.along = profile_along(before, after, std::min(a, b), std::max(a, b), o.lateral, middle_half);
  for (int iy = 0; iy < after.ny; ++iy) rut.y.push_back(after.y0 + iy * after.cell);

  double sum = 0.0;
  int count = 0, middle = 0;
  for (int iy = 0; iy < after.ny; ++iy) {
    const double off = std::abs(rut.y[iy] - o.lateral);
    if (off < std::abs(rut.y[middle] - o.lateral)) middle = iy;
    if (off > middle_half || !std::isfinite(rut.profile[iy])) continue;
    sum += rut.profile[iy];
    ++count;
  }
  if (count == 0) {
    const bool unchanged = before.height == after.height;  // hard ground with a profile
    rut.missing = unchanged ? "the ground keeps no rut" : "there are no grains where the tread went";
    return rut;
  }
  rut.measured = true;
  rut.depth = sum / count;
  rut.width = std::nan("");
  if (rut.depth <= 0.0) {
    rut.missing = "the ground behind the wheel is no lower than before";
    return rut;
  }
  rut.width = crossing(rut.y, rut.profile, middle, 1, 0.5 * rut.depth) -
              crossing(rut.y, rut.profile, middle, -1, 0.5 * rut.depth);
  return rut;
}

}  // namespace furrow::terrain
