#include "tire/reach.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "protocol/core/assert.hpp"

namespace furrow::tire {

double inflated_reach(Tire& tire, double camber) {
  FURROW_ASSERT(std::abs(camber) < 0.5 * std::numbers::pi, camber);
  tire.place(RimState());
  SurfaceState inflated;
  tire.surface(inflated);
  const double c = std::cos(camber), s = std::sin(camber);
  double most = 0.0;
  for (const Vec3& x : inflated.position) most = std::max(most, std::hypot(x.x(), x.z()) * c + std::abs(x.y() * s));
  return most;
}

}  // namespace furrow::tire
