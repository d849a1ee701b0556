#include "tire/ring/ring_carcass.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "protocol/core/archive_fields.hpp"
#include "protocol/core/assert.hpp"
#include "tire/ring/round_off_end.hpp"

namespace furrow::tire {
namespace {

constexpr double kTolerance = 1e-11;  // of the force that moves a segment's sidewall by the radius
constexpr double kStall = 128.0;      // round-offs of what (2) is summed from; a stiff belt was found to stall at 55
constexpr int kMostIterations = 40, kOneFactor = 8;
constexpr double kLeastRadius = 1.02;  // in radii of the rim

}  // namespace

RingCarcass::RingCarcass(const RingParams& params, const RingMotion& motion)
    : ring_(params),
      band_(params.segments),
      n_(params.segments),
      rim_radius_(motion.rim_radius),
      node_mass_(belt_mass(motion, params.radius) / n_),
      rest_mass_(motion.mass - node_mass_ * n_),
      rest_inertia_(rest_mass_ * motion.rim_radius * motion.rim_radius),
      damping_(motion.damping),
      tread_(n_),
      q_(ring_.zero()),
      r_(n_),
      w_(n_),
      r_before_(n_),
      change_(q_),
      middle_(q_),
      force_(q_),
      damped_(q_),
      target_(q_),
      left_(q_),
      tangent_(ring_.no_tangent()),
      lanes_(band_.entries()),
      air_(band_.unknowns()) {
  FURROW_ASSERT(damping_ >= 0.0, damping_);
  // Segments are numbered backwards from the top, in the direction of the angles of ring_mechanics.hpp.
  for (int j = 0; j < n_; ++j) {
    tread_[(n_ - j) % n_] = j;
    sine_.push_back(-std::sin(j * ring_.angle()));
    cosine_.push_back(std::cos(j * ring_.angle()));
  }
}

/// e_r = (sin, cos), e_t = (−cos, sin) of the segment's angle and the rim's together.
RingCarcass::Local RingCarcass::local(int j, double c, double s, double x, double z) const {
  const double sine = sine_[j] * c + cosine_[j] * s, cosine = cosine_[j] * c - sine_[j] * s;
  return {x * sine + z * cosine, z * sine - x * cosine};
}

PlanarPoint RingCarcass::plane(int j, double c, double s, Local p) const {
  const double sine = sine_[j] * c + cosine_[j] * s, cosine = cosine_[j] * c - sine_[j] * s;
  return {p.u * sine - p.v * cosine, p.u * cosine + p.v * sine};
}

void RingCarcass::set_pressure(double pressure) {
  if (pressure == ring_.params().pressure) return;
  const double before = ring_.energy(q_);
  ring_.set_pressure(pressure);
  pumped_ += ring_.energy(q_) - before;
}

void RingCarcass::lay_out() {
  const double c = std::cos(angle_), s = std::sin(angle_);
  for (int j = 0; j < n_; ++j) {
    const PlanarPoint p = plane(j, c, s, {ring_.radius() + q_.u[j], q_.v[j]});
    r_.x[j] = p.x, r_.z[j] = p.z;
  }
}

void RingCarcass::place(double angle, double spin, PlanarPoint velocity) {
  q_ = ring_.zero();
  angle_ = angle, spin_ = spin, centre_ = velocity;
  pumped_ = residual_ = 0.0, iterations_ = 0;
  lay_out();
  for (int j = 0; j < n_; ++j) w_.x[j] = spin * r_.z[j], w_.z[j] = -spin * r_.x[j];
}

/// Computes the known terms of (2), m_j (r + h w)/h² + f + m_j (g − A), and a first q' − q from r' = r + h w.
void RingCarcass::aim(double h, double turn, double middle, PlanarPoint acceleration, const PlanarField& load,
                      PlanarPoint gravity) {
  const double c = std::cos(middle), s = std::sin(middle), ct = std::cos(turn), st = std::sin(turn);
  const double stiff = node_mass_ / (h * h);
  const double gx = node_mass_ * (gravity.x - acceleration.x), gz = node_mass_ * (gravity.z - acceleration.z);
  for (int j = 0; j < n_; ++j) {
    const Local way = local(j, c, s, r_.x[j] + h * w_.x[j], r_.z[j] + h * w_.z[j]);
    const Local acts = local(j, c, s, load.x[j] + gx, load.z[j] + gz);
    target_.u[j] = stiff * way.u + acts.u, target_.v[j] = stiff * way.v + acts.v;
    change_.u[j] = ct * way.u - st * way.v - ring_.radius() - q_.u[j];  // turned back by δ: the rim turns on
    change_.v[j] = ct * way.v + st * way.u - q_.v[j];
  }
}

/// Factors A = m/h² + ½ ∂²Π + (τ/h) K at q_m, and computes A⁻¹ 1 for the air. @returns whether A is positive definite
bool RingCarcass::factorize(double h) {
  ring_.tangent(middle_, tangent_);
  const double share = 0.5 + damping_ / h, stiff = node_mass_ / (h * h);
  for (auto* blocks : {&tangent_.uu, &tangent_.uv, &tangent_.vu, &tangent_.vv})
    for (std::vector<double>& one : *blocks)
      for (double& value : one) value *= share;
  ring_.tension().add_tangent(middle_, -damping_ / h, tangent_);  // hoop tension is not damped
  for (int j = 0; j < n_; ++j) tangent_.uu[0][j] += stiff, tangent_.vv[0][j] += stiff;
  if (!band_.factorize(tangent_)) return false;
  std::fill(lanes_.begin(), lanes_.end(), 0.0);
  for (int j = 0; j < n_; ++j) lanes_[FoldedBand::kLanes * band_.place(j)] = 1.0;
  band_.solve(lanes_.data());
  double sum = 0.0;
  for (int j = 0; j < n_; ++j) {
    const int at = band_.place(j);
    air_[at] = lanes_[FoldedBand::kLanes * at], air_[at + 1] = lanes_[FoldedBand::kLanes * (at + 1)];
    sum += air_[at];
  }
  const double gas = 0.5 * tangent_.gas;
  air_share_ = gas / (1.0 + gas * sum);
  return true;
}

/// Computes the residual of (2). @returns its largest entry, N; NaN if the motion is not finite
double RingCarcass::residual(double h, double turn) {
  for (int j = 0; j < n_; ++j) {
    middle_.u[j] = q_.u[j] + 0.5 * change_.u[j];
    middle_.v[j] = q_.v[j] + 0.5 * change_.v[j];
  }
  ring_.gradient(middle_, force_);
  ring_.without_air(middle_, change_, damped_);
  const double ct = std::cos(turn), st = std::sin(turn), stiff = node_mass_ / (h * h), viscous = damping_ / h;
  double largest = 0.0, sum = 0.0;
  for (int j = 0; j < n_; ++j) {
    const double u = ring_.radius() + q_.u[j] + change_.u[j], v = q_.v[j] + change_.v[j];
    left_.u[j] = stiff * (ct * u + st * v) + ct * (force_.u[j] + viscous * damped_.u[j]) - target_.u[j];
    left_.v[j] = stiff * (ct * v - st * u) + ct * (force_.v[j] + viscous * damped_.v[j]) - target_.v[j];
    largest = std::max({largest, std::abs(left_.u[j]), std::abs(left_.v[j])});
    sum += left_.u[j] + left_.v[j];
  }
  return std::isfinite(sum) ? largest : sum;
}

void RingCarcass::correct() {
  std::fill(lanes_.begin(), lanes_.end(), 0.0);
  for (int j = 0; j < n_; ++j) {
    const int at = FoldedBand::kLanes * band_.place(j);
    lanes_[at] = -left_.u[j], lanes_[at + FoldedBand::kLanes] = -left_.v[j];
  }
  band_.solve(lanes_.data());
  double sum = 0.0;
  for (int j = 0; j < n_; ++j) sum += lanes_[FoldedBand::kLanes * band_.place(j)];
  for (int j = 0; j < n_; ++j) {
    const int at = band_.place(j);
    change_.u[j] += lanes_[FoldedBand::kLanes * at] - air_share_ * sum * air_[at];
    change_.v[j] += lanes_[FoldedBand::kLanes * (at + 1)] - air_share_ * sum * air_[at + 1];
  }
}

/// @returns whether (2) was solved
bool RingCarcass::solve(double h, double turn) {
  const double scale = ring_.radius() * ring_.slope(0.0);
  const double rounding = std::numeric_limits<double>::epsilon() * node_mass_ / (h * h) * ring_.radius();
  RoundOffEnd end;
  for (int k = 0; k <= kMostIterations; ++k) {
    const double left = residual(h, turn);
    residual_ = left / scale;
    const double round_off = rounding + ring_.rounding(middle_);
    if (end.reached(left, kTolerance * scale + round_off, left <= kTolerance * scale + kStall * round_off)) return true;
    if (!std::isfinite(left) || (k % kOneFactor == 0 && !factorize(h))) return false;
    correct();
    ++iterations_;
  }
  return false;
}

Outcome RingCarcass::step(double h, const PlaneRimStep& rim, const PlanarField& load, PlanarPoint gravity,
                          PlaneSums& sums) {
  FURROW_ASSERT(h > 0.0 && load.size() == r_.size(), h, load.size());
  const double turn = 0.5 * std::remainder(rim.angle - angle_, 2.0 * std::numbers::pi);
  const PlanarPoint acceleration{(rim.velocity.x - centre_.x) / h, (rim.velocity.z - centre_.z) / h};
  aim(h, turn, angle_ + turn, acceleration, load, gravity);
  if (!solve(h, turn))
    return Outcome::failure("did not converge",
                            fmt::format("residual {:.3g} of the force that moves a segment by the radius; try a "
                                        "smaller run.step",
                                        residual_));
  move(h, rim, turn, load, gravity, sums);
  return {};
}

/// Advances by the change that was found, and adds the terms of (4). The rim's impulses follow from the balances of
/// momentum and of angular momentum, with lever arms r_m. Its work on the segments is the work of −Σ R F over the
/// displacement and, by (3), −2 sin δ Σ F·R(−α_m) J r_m for the turn.
void RingCarcass::move(double h, const PlaneRimStep& rim, double turn, const PlanarField& load, PlanarPoint gravity,
                       PlaneSums& sums) {
  const double middle = angle_ + turn, c = std::cos(middle), s = std::sin(middle);
  const double viscous = damping_ / h, m = node_mass_;
  const double momentum_before = angular_momentum();
  std::swap(r_before_, r_);
  const PlanarField& before = r_before_;
  const double dx = rim.velocity.x - centre_.x, dz = rim.velocity.z - centre_.z;  // of the centre
  for (int j = 0; j < n_; ++j) q_.u[j] += change_.u[j], q_.v[j] += change_.v[j];
  angle_ += 2.0 * turn;
  lay_out();
  double push_x = 0.0, push_z = 0.0, moment = 0.0;  // of the rim on the tire
  double work_x = 0.0, work_z = 0.0, work_turn = 0.0, left_x = 0.0, left_z = 0.0, left_turn = 0.0, left_work = 0.0;
  double squares = 0.0, damped = 0.0;
  for (int j = 0; j < n_; ++j) {
    const double wx = (r_.x[j] - before.x[j]) / h, wz = (r_.z[j] - before.z[j]) / h;
    const double ax = wx - w_.x[j] + dx, az = wz - w_.z[j] + dz;  // Δv
    w_.x[j] = wx, w_.z[j] = wz;
    const double mx = 0.5 * (before.x[j] + r_.x[j]), mz = 0.5 * (before.z[j] + r_.z[j]);
    push_x += m * (ax / h - gravity.x) - load.x[j], push_z += m * (az / h - gravity.z) - load.z[j];
    const double fx = load.x[j] + m * (gravity.x - dx / h), fz = load.z[j] + m * (gravity.z - dz / h);
    moment -= mz * fx - mx * fz;
    squares += ax * ax + az * az;
    const Local force{force_.u[j] + viscous * damped_.u[j], force_.v[j] + viscous * damped_.v[j]};
    damped += viscous * (damped_.u[j] * change_.u[j] + damped_.v[j] * change_.v[j]);
    const PlanarPoint f = plane(j, c, s, force), left = plane(j, c, s, {left_.u[j], left_.v[j]});
    work_x -= f.x, work_z -= f.z;
    work_turn -= f.x * mz - f.z * mx;
    left_x += left.x, left_z += left.z;
    left_turn += left.x * before.z[j] - left.z * before.x[j];
    left_work += left.x * h * (wx + rim.velocity.x) + left.z * h * (wz + rim.velocity.z);
  }
  const double spin = 2.0 * turn / h, faster = spin - spin_;
  spin_ = spin, centre_ = rim.velocity;
  moment += (angular_momentum() - momentum_before) / h;
  push_x += rest_mass_ * (dx / h - gravity.x), push_z += rest_mass_ * (dz / h - gravity.z);
  work_x = std::cos(turn) * work_x + rest_mass_ * (dx / h - gravity.x);
  work_z = std::cos(turn) * work_z + rest_mass_ * (dz / h - gravity.z);
  sums.impulse_x -= h * push_x, sums.impulse_z -= h * push_z;
  sums.turn_impulse -= h * moment;
  const double left_on_rim = h * (left_x * rim.velocity.x + left_z * rim.velocity.z) + 2.0 * turn * left_turn;
  sums.rim_work += h * (work_x * rim.velocity.x + work_z * rim.velocity.z) + 2.0 * std::sin(turn) * work_turn +
                   rest_inertia_ * faster * spin + left_on_rim;
  sums.solver_loss += left_on_rim - left_work;
  sums.solver_impulse.x += h * left_x, sums.solver_impulse.z += h * left_z;
  sums.dissipation += damped;
  sums.numerical_loss += 0.5 * (m * squares + rest_mass_ * (dx * dx + dz * dz) + rest_inertia_ * faster * faster);
}

Outcome RingCarcass::check() const {
  double least = std::numeric_limits<double>::infinity();
  for (int j = 0; j < n_; ++j) least = std::min(least, std::hypot(r_.x[j], r_.z[j]));
  if (least < kLeastRadius * rim_radius_)
    return Outcome::failure("was pressed to its rim",
                            fmt::format("a segment is {:.4g} m from the axle, the rim {:.4g} m", least, rim_radius_));
  if (least < (1.0 - kMostRingDeflection) * ring_.radius())
    return Outcome::failure(
        "was pressed further than a flexible ring is meant for",
        fmt::format("by {:.4g} m, a quarter of its radius is {:.4g} m; try a smaller load or more pressure",
                    ring_.radius() - least, kMostRingDeflection * ring_.radius()));
  return {};
}

PlanarPoint RingCarcass::first_moment() const {
  PlanarPoint sum;
  for (int j = 0; j < n_; ++j) sum.x += node_mass_ * r_.x[j], sum.z += node_mass_ * r_.z[j];
  return sum;
}

PlanarPoint RingCarcass::momentum() const {
  PlanarPoint sum{rest_mass_ * centre_.x, rest_mass_ * centre_.z};
  for (int j = 0; j < n_; ++j) sum.x += node_mass_ * (centre_.x + w_.x[j]), sum.z += node_mass_ * (centre_.z + w_.z[j]);
  return sum;
}

double RingCarcass::angular_momentum() const {
  double sum = rest_inertia_ * spin_;
  for (int j = 0; j < n_; ++j) sum += node_mass_ * (r_.z[j] * w_.x[j] - r_.x[j] * w_.z[j]);
  return sum;
}

double RingCarcass::kinetic_energy() const {
  double sum = 0.5 * rest_mass_ * (centre_.x * centre_.x + centre_.z * centre_.z) + 0.5 * rest_inertia_ * spin_ * spin_;
  for (int j = 0; j < n_; ++j) {
    const double x = centre_.x + w_.x[j], z = centre_.z + w_.z[j];
    sum += 0.5 * node_mass_ * (x * x + z * z);
  }
  return sum;
}

void RingCarcass::save(Archive& archive) const {
  save_value(archive, "ring/u", q_.u), save_value(archive, "ring/v", q_.v);
  save_value(archive, "ring/velocity_x", w_.x), save_value(archive, "ring/velocity_z", w_.z);
  archive.put("ring/pressure", ring_.params().pressure);
  save_fields(archive, "ring", *this);
}

void RingCarcass::restore(const Archive& archive) {
  const auto n = static_cast<std::size_t>(n_);
  restore_value(archive, "ring/u", q_.u, n), restore_value(archive, "ring/v", q_.v, n);
  restore_value(archive, "ring/velocity_x", w_.x, n), restore_value(archive, "ring/velocity_z", w_.z, n);
  ring_.set_pressure(archive.get_double("ring/pressure"));
  restore_fields(archive, "ring", *this);
  lay_out();
}

}  // namespace furrow::tire
