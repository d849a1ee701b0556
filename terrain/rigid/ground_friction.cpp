#include "terrain/rigid/ground_friction.hpp"

#include <cmath>

#include "protocol/core/assert.hpp"

namespace furrow::terrain {
namespace {

constexpr int kMaxIterations = 60;
constexpr double kTolerance = 1e-15;  // of the sliding speed

/// Root of g s + limit tanh(c s) = drive. The left side is concave, so Newton's method from 0 rises to it.
double sliding_speed(double drive, double g, double limit, double c) {
  FURROW_ASSERT(drive >= 0.0 && g + limit * c > 0.0, drive, g, limit, c);
  double s = 0.0;
  for (int n = 0; n < kMaxIterations; ++n) {
    const double t = std::tanh(c * s);
    const double change = (drive - g * s - limit * t) / (g + limit * c * (1.0 - t * t));
    s += change;
    if (!(change > kTolerance * s)) break;
  }
  return s;
}

}  // namespace

Vec3 slide(const GroundLaw& law, double load, double area, const Vec3& velocity, double dt, Vec3& shear, double* grip) {
  FURROW_ASSERT(load >= 0.0 && area >= 0.0, load, area);
  FURROW_ASSERT(dt > 0.0, dt);
  if (grip) *grip = 0.0;
  const double limit = law.friction * load, stiffness = law.shear_stiffness * area;
  if (!(limit > 0.0) || !(stiffness > 0.0)) {
    shear = Vec3::Zero();
    return Vec3::Zero();
  }
  // Backward Euler: ξ' = ξ + dt (v − s), so the layer's force is drive − g s along one direction.
  const Vec3 flat(velocity.x(), velocity.y(), 0.0);
  const double g = stiffness * dt + law.damping * area;
  const Vec3 drive = stiffness * shear + g * flat;
  const double size = drive.norm();
  const double sliding = sliding_speed(size, g, limit, law.velocity_scale);
  if (grip) {
    const double t = std::tanh(law.velocity_scale * sliding);
    const double viscosity = limit * law.velocity_scale * (1.0 - t * t);  // of the friction, N s/m
    *grip = viscosity / (g + viscosity);
  }
  if (!(size > 0.0)) return Vec3::Zero();
  const Vec3 direction = drive / size;
  shear += dt * (flat - sliding * direction);
  return -(size - g * sliding) * direction;
}

}  // namespace furrow::terrain
