#include "tire/planar/planar_carcass.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "protocol/core/assert.hpp"
#include "tire/planar/planar_tangent.hpp"

namespace furrow::tire {
namespace {

/// With a node at the top, as cylinder() has vertices.
PlanarMesh annulus(const PlanarWheelSize& size) {
  PlanarMesh mesh = planar_annulus(size.rim_radius, size.radius, size.rings, size.around);
  for (double& x : mesh.position.x) x = -x;
  for (double& z : mesh.position.z) z = -z;
  return mesh;
}

}  // namespace

PlanarCarcass::PlanarCarcass(const PlanarParams& params)
    : mesh_(annulus(params.size)),
      elements_(mesh_, std::span(&params.tire, 1), params.options),
      held_(mesh_.position.size(), 0),
      r_(mesh_.position),
      u_(mesh_.position.size()),
      internal_(mesh_.position.size()),
      internal_before_(mesh_.position.size()),
      target_(mesh_.position.size()) {
  for (const int n : mesh_.inner) held_[n] = 1;
  const PlanarField& p = mesh_.position;
  for (std::size_t n = 0; n < p.size(); ++n) {
    total_mass_ += mass()[n];
    spin_inertia_ += mass()[n] * (p.x[n] * p.x[n] + p.z[n] * p.z[n]);
  }
}

void PlanarCarcass::place(double angle, double spin, PlanarPoint velocity) {
  const double c = std::cos(angle), s = std::sin(angle);
  const PlanarField& p = mesh_.position;
  for (std::size_t n = 0; n < p.size(); ++n) {
    r_.x[n] = c * p.x[n] + s * p.z[n], r_.z[n] = c * p.z[n] - s * p.x[n];
    u_.x[n] = spin * r_.z[n], u_.z[n] = -spin * r_.x[n];
  }
  centre_ = velocity;
  renew();
}

void PlanarCarcass::restore(PlanarField position, PlanarField velocity, PlanarPoint centre_velocity) {
  FURROW_ASSERT(position.size() == r_.size() && velocity.size() == r_.size(), position.size(),
                velocity.size(), r_.size());
  r_ = std::move(position), u_ = std::move(velocity), centre_ = centre_velocity;
  renew();
}

/// What follows from positions and velocities alone: nothing of it is saved.
void PlanarCarcass::renew() {
  elements_.force(r_, u_, internal_);
  power_ = elements_.viscous_power(r_, u_);
}

void PlanarCarcass::hold(double h, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  const PlanarField& p = mesh_.position;
  for (const int n : mesh_.inner) {
    target_.x[n] = (c * p.x[n] + s * p.z[n] - r_.x[n]) / h;
    target_.z[n] = (c * p.z[n] - s * p.x[n] - r_.z[n]) / h;
  }
}

bool PlanarCarcass::step(double h, const PlanarRimStep& rim, const PlanarField& load, PlanarPoint gravity,
                         PlanarSums& sums) {
  FURROW_ASSERT(h > 0.0 && load.size() == r_.size(), h, load.size());
  const double ax = (rim.velocity.x - centre_.x) / h, az = (rim.velocity.z - centre_.z) / h;
  hold(h, rim.angle);
  double squares = 0.0;  // Σ m |Δv|²
  for (std::size_t n = 0; n < r_.size(); ++n) {
    const double m = mass()[n], fx = internal_.x[n] + load.x[n], fz = internal_.z[n] + load.z[n];
    double dx = h * (fx / m + gravity.x), dz = h * (fz / m + gravity.z);  // Δv
    if (held_[n]) {
      dx = target_.x[n] - u_.x[n] + h * ax, dz = target_.z[n] - u_.z[n] + h * az;
      const double ix = m * (dx - h * gravity.x) - h * fx, iz = m * (dz - h * gravity.z) - h * fz;  // h R
      sums.impulse_x -= ix, sums.impulse_z -= iz;
      sums.turn_impulse -= r_.z[n] * ix - r_.x[n] * iz;
      sums.rim_work += ix * (rim.velocity.x + target_.x[n]) + iz * (rim.velocity.z + target_.z[n]);
      u_.x[n] = target_.x[n], u_.z[n] = target_.z[n];
    } else {
      u_.x[n] += dx - h * ax, u_.z[n] += dz - h * az;
    }
    squares += m * (dx * dx + dz * dz);
    r_.x[n] += h * u_.x[n], r_.z[n] += h * u_.z[n];
  }
  centre_ = rim.velocity;
  std::swap(internal_, internal_before_);
  const bool sound = elements_.force(r_, u_, internal_);
  double change = 0.0;  // Σ (F_int' − F_int)·Δr
  for (std::size_t n = 0; n < r_.size(); ++n)
    change += h * ((internal_.x[n] - internal_before_.x[n]) * u_.x[n] +
                   (internal_.z[n] - internal_before_.z[n]) * u_.z[n]);
  const double power = elements_.viscous_power(r_, u_);
  sums.numerical_loss += 0.5 * (squares + change);
  sums.dissipation += 0.5 * h * (power_ + power);
  power_ = power;
  return sound;
}

double PlanarCarcass::step_limit() const { return furrow::tire::step_limit(elements_, r_); }

PlanarPoint PlanarCarcass::first_moment() const {
  PlanarPoint sum;
  for (std::size_t n = 0; n < r_.size(); ++n) sum.x += mass()[n] * r_.x[n], sum.z += mass()[n] * r_.z[n];
  return sum;
}

PlanarPoint PlanarCarcass::momentum() const {
  PlanarPoint sum;
  for (std::size_t n = 0; n < r_.size(); ++n)
    sum.x += mass()[n] * (centre_.x + u_.x[n]), sum.z += mass()[n] * (centre_.z + u_.z[n]);
  return sum;
}

double PlanarCarcass::angular_momentum() const {
  double sum = 0.0;
  for (std::size_t n = 0; n < r_.size(); ++n) sum += mass()[n] * (r_.z[n] * u_.x[n] - r_.x[n] * u_.z[n]);
  return sum;
}

double PlanarCarcass::kinetic_energy() const {
  double sum = 0.0;
  for (std::size_t n = 0; n < r_.size(); ++n) {
    const double x = centre_.x + u_.x[n], z = centre_.z + u_.z[n];
    sum += 0.5 * mass()[n] * (x * x + z * z);
  }
  return sum;
}

double PlanarCarcass::least_radius() const {
  double least = std::numeric_limits<double>::infinity();
  for (const int n : mesh_.outer) least = std::min(least, std::hypot(r_.x[n], r_.z[n]));
  return least;
}

}  // namespace furrow::tire
