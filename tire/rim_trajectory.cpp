// x(s) = h₀₀ x₀ + h₁₀ T v₀ + h₀₁ x₁ + h₁₁ T v₁ with the cubic Hermite basis, s = (t − t₀)/T. The orientation
// is exp(φ(s)) q₀ with φ the same curve from 0 to the turn between the end orientations. φ̇ equals ω only to
// first order in φ: a turn of one interval is ωT ≈ 4e-4 rad and ω keeps its direction, so that the commutator
// ½ φ × φ̇ vanishes for steady spin and is below 1e-7 rad/s otherwise. Both end states are met exactly.
#include "tire/rim_trajectory.hpp"

#include <cmath>

#include "protocol/core/archive_fields.hpp"
#include "protocol/core/assert.hpp"

namespace furrow::tire {
namespace {

Quat rotation(const Vec3& turn) {
  const double angle = turn.norm();
  if (angle < 1e-12) return Quat(1.0, 0.5 * turn.x(), 0.5 * turn.y(), 0.5 * turn.z()).normalized();
  return Quat(Eigen::AngleAxisd(angle, turn / angle));
}

Vec3 turn_between(const Quat& from, const Quat& to) {
  Quat q = to * from.conjugate();
  if (q.w() < 0.0) q.coeffs() = -q.coeffs();
  const double sine = q.vec().norm();
  if (sine < 1e-12) return 2.0 * q.vec();
  return 2.0 * std::atan2(sine, q.w()) / sine * q.vec();
}

struct Hermite {
  Vec3 value, rate, second;
};

Hermite hermite(const Vec3& x0, const Vec3& v0, const Vec3& x1, const Vec3& v1, double duration, double s) {
  FURROW_ASSERT(duration > 0.0, duration);
  const double s2 = s * s, s3 = s2 * s;
  const Vec3 m0 = duration * v0, m1 = duration * v1;
  Hermite h;
  h.value = (2 * s3 - 3 * s2 + 1) * x0 + (s3 - 2 * s2 + s) * m0 + (3 * s2 - 2 * s3) * x1 + (s3 - s2) * m1;
  h.rate = ((6 * s2 - 6 * s) * (x0 - x1) + (3 * s2 - 4 * s + 1) * m0 + (3 * s2 - 2 * s) * m1) / duration;
  h.second = ((12 * s - 6) * (x0 - x1) + (6 * s - 4) * m0 + (6 * s - 2) * m1) / (duration * duration);
  return h;
}

}  // namespace

RimTrajectory::RimTrajectory(const RimState& start) : start_(start), end_(start) {}

void RimTrajectory::extend(const RimState& received, double duration) {
  extend(received, duration, duration * received.velocity, duration * received.angular_velocity);
}

void RimTrajectory::extend_accelerated(const RimState& received, double duration) {
  // The velocities at the end of the last interval are the rim's velocities of one step before.
  extend(received, duration, duration * (1.5 * received.velocity - 0.5 * end_.velocity),
         duration * (1.5 * received.angular_velocity - 0.5 * end_.angular_velocity));
}

void RimTrajectory::extend(const RimState& received, double duration, const Vec3& way, const Vec3& turn) {
  FURROW_ASSERT(duration > 0.0 && std::isfinite(duration), duration);
  start_ = end_;
  duration_ = duration;
  end_.position = received.position + way;
  end_.orientation = (rotation(turn) * received.orientation).normalized();
  end_.velocity = received.velocity;
  end_.angular_velocity = received.angular_velocity;
  turn_ = turn_between(start_.orientation, end_.orientation);
}

RimKinematics RimTrajectory::at(double s) const {
  FURROW_ASSERT(s >= 0.0 && s <= 1.0, s);
  if (s >= 1.0 && duration_ == 0.0) return {end_, Vec3::Zero()};
  const Hermite x = hermite(start_.position, start_.velocity, end_.position, end_.velocity, duration_, s);
  const Hermite phi = hermite(Vec3::Zero(), start_.angular_velocity, turn_, end_.angular_velocity, duration_, s);
  RimKinematics k;
  k.state.position = x.value;
  k.state.velocity = x.rate;
  k.acceleration = x.second;
  k.state.orientation = end_.orientation;
  if (s < 1.0) k.state.orientation = (rotation(phi.value) * start_.orientation).normalized();
  k.state.angular_velocity = phi.rate;
  return k;
}

void RimTrajectory::save(Archive& archive) const { save_fields(archive, "trajectory", *this); }

void RimTrajectory::restore(const Archive& archive) { restore_fields(archive, "trajectory", *this); }

}  // namespace furrow::tire
