#include "tire/planar/planar_carcass.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "protocol/core/archive_fields.hpp"
#include "protocol/core/assert.hpp"
#include "tire/planar/planar_tangent.hpp"

namespace furrow::tire {
namespace {

constexpr int kStepsBetweenChecks = 500;  // of the step's limit in the present shape
constexpr int kMostSubsteps = 1000;       // in one step of the scenario
constexpr double kLeastRadius = 1.02;     // of outer nodes, in radii of the rim

/// The tire, with an elastic disc the wheel, with a node at the top, like the vertices of cylinder().
PlanarMesh mesh_of(const PlanarParams& params) {
  const PlanarWheelSize& size = params.size;
  PlanarMesh mesh = params.disc_in_run == PlanarDisc::elastic
                        ? planar_wheel(size)
                        : planar_annulus(size.rim_radius, size.radius, size.rings, size.around);
  for (double& x : mesh.position.x) x = -x;
  for (double& z : mesh.position.z) z = -z;
  return mesh;
}

/// The inner edge, or the middle of the disc and the nodes that share a triangle with it.
std::vector<int> nodes_on_rim(const PlanarMesh& mesh) {
  if (mesh.centre < 0) return mesh.inner;
  std::vector<int> nodes;
  for (const auto& t : mesh.triangles)
    if (std::ranges::find(t, mesh.centre) != t.end()) nodes.insert(nodes.end(), t.begin(), t.end());
  std::ranges::sort(nodes);
  nodes.erase(std::ranges::unique(nodes).begin(), nodes.end());
  return nodes;
}

PlanarElements elements_of(const PlanarMesh& mesh, const PlanarParams& params) {
  if (mesh.centre >= 0) return planar_elements(mesh, params);
  return PlanarElements(mesh, std::span(&params.tire, 1), params.options);
}

}  // namespace

PlanarCarcass::PlanarCarcass(const PlanarParams& params)
    : mesh_(mesh_of(params)),
      elements_(elements_of(mesh_, params)),
      integrator_(params.integrator),
      rim_radius_(params.size.rim_radius),
      share_(params.step_share),
      tread_(mesh_.outer.size()),
      held_nodes_(nodes_on_rim(mesh_)),
      held_(mesh_.position.size(), 0),
      r_(mesh_.position),
      u_(mesh_.position.size()),
      internal_(mesh_.position.size()),
      internal_before_(mesh_.position.size()),
      target_(mesh_.position.size()),
      touching_(mesh_.position.size()),
      v_(mesh_.position.size()) {
  const int around = params.size.around;
  for (int k = 0; k < around; ++k) tread_[(around - k) % around] = mesh_.outer[k];
  for (const int n : held_nodes_) held_[n] = 1;
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
  steps_ = since_check_ = 0;
  limit_ = step_limit();
  renew();
}

void PlanarCarcass::save(Archive& archive) const {
  save_value(archive, "planar/x", r_.x), save_value(archive, "planar/z", r_.z);
  save_value(archive, "planar/velocity_x", u_.x), save_value(archive, "planar/velocity_z", u_.z);
  save_fields(archive, "planar", *this);
}

void PlanarCarcass::restore(const Archive& archive) {
  const std::size_t nodes = r_.size();
  restore_value(archive, "planar/x", r_.x, nodes), restore_value(archive, "planar/z", r_.z, nodes);
  restore_value(archive, "planar/velocity_x", u_.x, nodes);
  restore_value(archive, "planar/velocity_z", u_.z, nodes);
  restore_fields(archive, "planar", *this);
  renew();
}

/// Computes the values that follow from positions and velocities alone. They are not saved.
void PlanarCarcass::renew() {
  elements_.force(r_, u_, internal_);
  power_ = elements_.viscous_power(r_, u_);
}

void PlanarCarcass::hold(double h, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  const PlanarField& p = mesh_.position;
  for (const int n : held_nodes_) {
    target_.x[n] = (c * p.x[n] + s * p.z[n] - r_.x[n]) / h;
    target_.z[n] = (c * p.z[n] - s * p.x[n] - r_.z[n]) / h;
  }
}

Outcome PlanarCarcass::parts(double h, int& count) {
  if (since_check_ >= kStepsBetweenChecks) limit_ = step_limit(), since_check_ = 0;
  count = static_cast<int>(std::ceil(std::min(h / (share_ * limit_), 2.0 * kMostSubsteps)));
  if (h <= kMostSubsteps * share_ * limit_) return {};
  return Outcome::failure("is pressed too thin for its explicit steps",
                          fmt::format("stable steps are below {:.3g} s, more than {} of them in {:.3g} s: "
                                      "try a smaller run.step, a stiffer tire or a coarser mesh",
                                      share_ * limit_, kMostSubsteps, h));
}

Outcome PlanarCarcass::step(double h, const PlaneRimStep& rim, const PlanarField& load, PlanarPoint gravity,
                            PlaneSums& sums) {
  FURROW_ASSERT(h > 0.0 && load.size() == r_.size(), h, load.size());
  hold(h, rim.angle);
  const bool sound = integrator_ == PlanarIntegrator::runge_kutta_4 ? runge_kutta(h, rim, load, gravity, sums)
                                                                    : euler(h, rim, load, gravity, sums);
  const double power = elements_.viscous_power(r_, u_);
  sums.dissipation += 0.5 * h * (power_ + power);
  power_ = power;
  ++steps_, ++since_check_;
  if (sound) return {};
  return Outcome::failure("has a triangle that is turned inside out",
                          "try a smaller run.step or step_share, a stiffer tire or a coarser mesh");
}

/// Forces of the contact at x, from the rim's centre at the step's start, with the velocities v_. They act for a share
/// of the step h.
const PlanarField& PlanarCarcass::touch(const PlanarField& x, double h, double share) {
  for (const int n : tread_) touching_.x[n] = touching_.z[n] = 0.0;
  if (contact_) contact_->add(x, v_, h, share * h, touching_);
  return touching_;
}

bool PlanarCarcass::euler(double h, const PlaneRimStep& rim, const PlanarField& load, PlanarPoint gravity,
                          PlaneSums& sums) {
  const double ax = (rim.velocity.x - centre_.x) / h, az = (rim.velocity.z - centre_.z) / h;
  for (std::size_t n = 0; contact_ && n < r_.size(); ++n) v_.x[n] = centre_.x + u_.x[n], v_.z[n] = centre_.z + u_.z[n];
  const PlanarField& contact = touch(r_, h, 1.0);
  double squares = 0.0;  // Σ m |Δv|²
  for (std::size_t n = 0; n < r_.size(); ++n) {
    const double m = mass()[n], fx = internal_.x[n] + load.x[n] + contact.x[n],
                 fz = internal_.z[n] + load.z[n] + contact.z[n];
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
  for (const int n : tread_)
    sums.contact_work += h * (contact.x[n] * (centre_.x + u_.x[n]) + contact.z[n] * (centre_.z + u_.z[n]));
  std::swap(internal_, internal_before_);
  const bool sound = elements_.force(r_, u_, internal_);
  double change = 0.0;  // Σ (F_int' − F_int)·Δr
  for (std::size_t n = 0; n < r_.size(); ++n)
    change +=
        h * ((internal_.x[n] - internal_before_.x[n]) * u_.x[n] + (internal_.z[n] - internal_before_.z[n]) * u_.z[n]);
  sums.numerical_loss += 0.5 * (squares + change);
  return sound;
}

/// Positions of stages count from the rim's centre at the step's start. The step's own end is the next one's first
/// stage, so it costs four evaluations of internal forces.
bool PlanarCarcass::runge_kutta(double h, const PlaneRimStep& rim, const PlanarField& load, PlanarPoint gravity,
                                PlaneSums& sums) {
  constexpr double kAt[] = {0.0, 0.5, 0.5, 1.0}, kWeight[] = {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};
  const std::size_t nodes = r_.size();
  for (std::size_t n = 0; n < nodes; ++n) v_.x[n] = centre_.x + u_.x[n], v_.z[n] = centre_.z + u_.z[n];
  for (const int n : held_nodes_) {
    const double m = mass()[n], x = rim.velocity.x + target_.x[n], z = rim.velocity.z + target_.z[n];
    const double dx = x - v_.x[n], dz = z - v_.z[n], ix = m * dx, iz = m * dz;
    sums.impulse_x -= ix, sums.impulse_z -= iz;
    sums.turn_impulse -= r_.z[n] * ix - r_.x[n] * iz;
    sums.rim_work += ix * x + iz * z;
    sums.numerical_loss += 0.5 * m * (dx * dx + dz * dz);
    v_.x[n] = x, v_.z[n] = z;
  }
  start_.x = r_, start_.v = v_;
  sum_ = start_;
  stage_ = r_;
  bool sound = true;
  for (int k = 0; k < 4; ++k) {
    if (k > 0) sound = elements_.force(stage_, v_, internal_) && sound;
    const double weight = kWeight[k] * h, next = k < 3 ? kAt[k + 1] * h : 0.0;
    const PlanarField& contact = touch(stage_, h, kWeight[k]);
    for (const int n : tread_) sums.contact_work += weight * (contact.x[n] * v_.x[n] + contact.z[n] * v_.z[n]);
    for (std::size_t n = 0; n < nodes; ++n) {
      const double m = mass()[n], fx = internal_.x[n] + load.x[n] + contact.x[n],
                   fz = internal_.z[n] + load.z[n] + contact.z[n];
      double ax = fx / m + gravity.x, az = fz / m + gravity.z;
      if (held_[n]) {
        const double ix = -weight * m * ax, iz = -weight * m * az;  // of R
        const double x = stage_.x[n] - kAt[k] * h * rim.velocity.x, z = stage_.z[n] - kAt[k] * h * rim.velocity.z;
        sums.impulse_x -= ix, sums.impulse_z -= iz;
        sums.turn_impulse -= z * ix - x * iz;
        sums.rim_work += ix * v_.x[n] + iz * v_.z[n];
        ax = az = 0.0;
      }
      sum_.x.x[n] += weight * v_.x[n], sum_.x.z[n] += weight * v_.z[n];
      sum_.v.x[n] += weight * ax, sum_.v.z[n] += weight * az;
      stage_.x[n] = start_.x.x[n] + next * v_.x[n], stage_.z[n] = start_.x.z[n] + next * v_.z[n];
      v_.x[n] = start_.v.x[n] + next * ax, v_.z[n] = start_.v.z[n] + next * az;
    }
  }
  centre_ = rim.velocity;
  for (std::size_t n = 0; n < nodes; ++n) {
    r_.x[n] = sum_.x.x[n] - h * centre_.x, r_.z[n] = sum_.x.z[n] - h * centre_.z;
    u_.x[n] = sum_.v.x[n] - centre_.x, u_.z[n] = sum_.v.z[n] - centre_.z;
  }
  return elements_.force(r_, u_, internal_) && sound;
}

Outcome PlanarCarcass::check() const {
  const double least = least_radius();
  if (!std::isfinite(least)) return Outcome::failure("has a motion that is not finite", "try a smaller run.step");
  if (least < kLeastRadius * rim_radius_)
    return Outcome::failure(
        "was pressed to its rim",
        fmt::format("a node of the tread is {:.4g} m from the axle, the rim {:.4g} m", least, rim_radius_));
  return {};
}

double PlanarCarcass::tread_mass() const {
  double sum = 0.0;
  for (const int n : tread_) sum += mass()[n];
  return sum;
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
