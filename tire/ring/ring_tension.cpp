#include "tire/ring/ring_tension.hpp"

#include <cmath>
#include <numbers>

namespace furrow::tire {

RingTension::RingTension(int segments, double radius) : n_(segments) {
  const double half = std::numbers::pi / segments;
  sine_ = std::sin(half), cosine_ = std::cos(half);
  sine_2_ = std::sin(2.0 * half), cosine_2_ = std::cos(2.0 * half);
  chord_ = 2.0 * radius * sine_, line_ = radius * cosine_;
}

double RingTension::stiffest() const { return 2.0 * std::abs(strength_) * line_ / chord_; }

RingTension::Chord RingTension::chord(const RingField& q, int j, int next) const {
  const double turn = (q.u[next] - q.u[j]) * cosine_ - (q.v[next] + q.v[j]) * sine_;
  const double along = chord_ + (q.u[next] + q.u[j]) * sine_ + (q.v[next] - q.v[j]) * cosine_;
  return {turn, along, std::sqrt(along * along + turn * turn)};
}

double RingTension::energy(const RingField& q) const {
  if (strength_ == 0.0) return 0.0;
  double sum = 0.0;
  for (int j = 0; j < n_; ++j) {
    const int next = j + 1 < n_ ? j + 1 : 0;
    const Chord c = chord(q, j, next);
    sum += line_ * c.turn * c.turn / (c.length + c.along) - 0.5 * sine_2_ * (q.u[j] * q.u[next] + q.v[j] * q.v[next]) -
           0.5 * cosine_2_ * (q.u[j] * q.v[next] - q.v[j] * q.u[next]);
  }
  return strength_ * sum;
}

// ∂e/∂n = n/l,   ∂e/∂a = (l₀ + a)/l − 1 = −n²/(l (l + l₀ + a)).
void RingTension::add_gradient(const RingField& q, RingField& out) const {
  if (strength_ == 0.0) return;
  const double area = 0.5 * strength_;
  for (int j = 0; j < n_; ++j) {
    const int next = j + 1 < n_ ? j + 1 : 0;
    const Chord c = chord(q, j, next);
    const double by_turn = strength_ * line_ * c.turn / c.length;
    const double by_stretch = -by_turn * c.turn / (c.length + c.along);
    const double in = by_stretch * sine_, on = by_stretch * cosine_, across = by_turn * cosine_, back = by_turn * sine_;
    out.u[j] += in - across - area * (sine_2_ * q.u[next] + cosine_2_ * q.v[next]);
    out.v[j] += -on - back - area * (sine_2_ * q.v[next] - cosine_2_ * q.u[next]);
    out.u[next] += in + across - area * (sine_2_ * q.u[j] - cosine_2_ * q.v[j]);
    out.v[next] += on - back - area * (sine_2_ * q.v[j] + cosine_2_ * q.u[j]);
  }
}

// With the unit vector t = (l₀ + a, n)/l of the chord, ∂²e = m mᵀ / l, m = t_a ∂n − t_n ∂a.
void RingTension::add_tangent(const RingField& q, double factor, RingTangent& out) const {
  if (strength_ == 0.0) return;
  const double area = 0.5 * factor * strength_;
  for (int j = 0; j < n_; ++j) {
    const int next = j + 1 < n_ ? j + 1 : 0;
    const Chord c = chord(q, j, next);
    const double along = c.along / c.length, turn = c.turn / c.length;
    const double u0 = -along * cosine_ - turn * sine_, v0 = -along * sine_ + turn * cosine_;
    const double u1 = along * cosine_ - turn * sine_, v1 = -along * sine_ - turn * cosine_;
    const double f = factor * strength_ * line_ / c.length;
    out.uu[0][j] += f * u0 * u0, out.uv[0][j] += f * u0 * v0, out.vu[0][j] += f * v0 * u0, out.vv[0][j] += f * v0 * v0;
    out.uu[0][next] += f * u1 * u1, out.uv[0][next] += f * u1 * v1;
    out.vu[0][next] += f * v1 * u1, out.vv[0][next] += f * v1 * v1;
    out.uu[1][j] += f * u0 * u1 - area * sine_2_, out.uv[1][j] += f * u0 * v1 - area * cosine_2_;
    out.vu[1][j] += f * v0 * u1 + area * cosine_2_, out.vv[1][j] += f * v0 * v1 - area * sine_2_;
  }
}

}  // namespace furrow::tire
