#include "vehicle/multibody/strut_laws.hpp"

#include <algorithm>
#include <cmath>

#include "protocol/core/error.hpp"

namespace furrow::vehicle {
namespace {

/// 0 below the mark, 1 above, in between the C² smoothstep over the width.
double smoothstep(double x, double mark, double width) {
  if (!std::isfinite(mark)) return mark > 0.0 ? 0.0 : 1.0;
  const double u = std::clamp((x - mark) / width + 0.5, 0.0, 1.0);
  return u * u * u * (10.0 + u * (6.0 * u - 15.0));
}

void require(bool ok, const std::string& what) {
  if (!ok) throw physics_error(what);
}

}  // namespace

ForceLaw tabulated_spring(const SpringOptions& options) {
  require(options.force.has_value(), "spring: it has no table");
  require(options.free_length > 0.0 && std::isfinite(options.free_length), "spring: its free length must be positive");
  require(options.shortest < options.longest, "spring: its stops must be in rising order");
  if (options.stop)
    require(options.stop->value(0.0) == 0.0 && options.stop->first() >= 0.0, "spring: its stop must begin at (0, 0)");
  return [o = options](double x, double, double) {
    ElementForce f;
    f.elastic = o.force->value(o.free_length - x);
    f.energy = o.force->integral(o.free_length - x);
    if (o.stop && x < o.shortest) {
      f.elastic += o.stop->value(o.shortest - x);
      f.energy += o.stop->integral(o.shortest - x);
    }
    if (o.stop && x > o.longest) {
      f.elastic -= o.stop->value(x - o.longest);
      f.energy += o.stop->integral(x - o.longest);
    }
    f.force = f.elastic;
    return f;
  };
}

double shock_coefficient(const ShockOptions& o, double length, double speed) {
  const double inside =
      smoothstep(length, o.first_mark, o.blend_length) * (1.0 - smoothstep(length, o.last_mark, o.blend_length));
  const double bump = o.outer_bump + (o.bump - o.outer_bump) * inside;
  const double rebound = o.outer_rebound + (o.rebound - o.outer_rebound) * inside;
  double share = speed > 0.0 ? 1.0 : 0.0;  // of rebound
  if (o.blend_speed > 0.0) share = std::clamp(speed / o.blend_speed + 0.5, 0.0, 1.0);
  return bump + (rebound - bump) * share;
}

ForceLaw shock_absorber(const ShockOptions& options) {
  const ShockOptions& o = options;
  require(o.bump >= 0.0 && o.rebound >= 0.0 && o.outer_bump >= 0.0 && o.outer_rebound >= 0.0,
          "shock absorber: its coefficients must not be negative");
  require(o.first_mark < o.last_mark, "shock absorber: its marks must be in rising order");
  const bool marked = std::isfinite(o.first_mark) || std::isfinite(o.last_mark);
  require(!marked || o.blend_length > 0.0, "shock absorber: the length over which it changes must be positive");
  if (std::isfinite(o.first_mark) && std::isfinite(o.last_mark))
    require(o.last_mark - o.first_mark >= o.blend_length,
            "shock absorber: its marks must lie further apart than the "
            "length over which it changes");
  require(o.blend_speed >= 0.0, "shock absorber: its blend speed must not be negative");
  // The slope is the secant through the origin, so that the implicit half of the step dissipates energy, too.
  return [o](double x, double v, double) {
    const double c = shock_coefficient(o, x, v);
    return ElementForce{-c * v, c};
  };
}

}  // namespace furrow::vehicle
