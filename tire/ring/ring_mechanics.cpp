#include "tire/ring/ring_mechanics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "protocol/core/assert.hpp"

namespace furrow::tire {

RingMechanics::RingMechanics(const RingParams& params)
    : params_(params),
      n_(params.segments),
      phi_(2.0 * std::numbers::pi / params.segments),
      radius_(params.radius),
      volume_(params.air_share * std::numbers::pi * radius_ * radius_ * params.width),
      first_(0.5 / std::sin(phi_)),
      second_(0.25 / (std::sin(0.5 * phi_) * std::sin(0.5 * phi_))),
      share_(radius_ * phi_ * params.width),
      tension_(params.segments, params.radius) {
  FURROW_ASSERT(n_ >= kMinSegments, n_);
  FURROW_ASSERT(params.ambient > 0.0 && params.air_share > 0.0, params.ambient, params.air_share);
  set_pressure(params.pressure);
  // Block (j, j + d) of (2): φ Σ_o A b(o) b(o + d)ᵀ + B a(o) a(o + d)ᵀ; o: place of segment j relative to the measure's
  // own segment, −1, 0, 1.
  const double f = first_, g = second_;
  const double b[3][2] = {{-g, -f}, {2.0 * g, 0.0}, {-g, f}};  // of D₁v − D₂u: by u, v
  const double a[3][2] = {{-f, g}, {0.0, -2.0 * g}, {f, g}};   // of D₁u + D₂v
  for (int d = 0; d < 3; ++d)
    for (int row = 0; row < 2; ++row)
      for (int column = 0; column < 2; ++column) {
        double sum = 0.0;
        for (int o = 0; o + d < 3; ++o)
          sum += params.bending * b[o][row] * b[o + d][column] + params.shear * a[o][row] * a[o + d][column];
        belt_[d][2 * row + column] = phi_ * sum;
      }
  a_.resize(n_), b_.resize(n_);
}

void RingMechanics::set_pressure(double pressure) {
  params_.pressure = pressure;
  const double q = draw_ = sidewall_draw(params_);
  const double k1 = params_.sidewall_1, k2 = params_.sidewall_2, k3 = params_.sidewall_3;
  s_ = {pressure * radius_ * params_.width, k1 + q * (2.0 * k2 + 3.0 * k3 * q), k2 + 3.0 * k3 * q, k3};
  tension_.set(params_.tension_share * pressure * params_.width);
}

RingField RingMechanics::zero() const { return {std::vector<double>(n_), std::vector<double>(n_)}; }

RingTangent RingMechanics::no_tangent() const {
  RingTangent t;
  for (auto* blocks : {&t.uu, &t.uv, &t.vu, &t.vv})
    for (std::vector<double>& one : *blocks) one.resize(n_);
  return t;
}

double RingMechanics::belt_energy(const RingField& q) const {
  double sum = 0.0;
  with_neighbours([&](int l, int j, int r) {
    const double du = first_ * (q.u[r] - q.u[l]), ddu = second_ * (q.u[r] - 2.0 * q.u[j] + q.u[l]);
    const double dv = first_ * (q.v[r] - q.v[l]), ddv = second_ * (q.v[r] - 2.0 * q.v[j] + q.v[l]);
    sum += params_.bending * (dv - ddu) * (dv - ddu) + params_.shear * (du + ddv) * (du + ddv);
  });
  return 0.5 * phi_ * sum;
}

double RingMechanics::air_energy(const RingField& q) const {
  const double change = share_ * std::accumulate(q.u.begin(), q.u.end(), 0.0);
  const double absolute = params_.pressure + params_.ambient;
  return params_.gas == RingGas::exact ? params_.ambient * change - absolute * volume_ * std::log1p(change / volume_)
                                       : change * (0.5 * absolute * change / volume_ - params_.pressure);
}

double RingMechanics::energy(const RingField& q) const {
  double sidewall = 0.0;
  for (int j = 0; j < n_; ++j) {
    const double u = q.u[j];
    sidewall += u * (s_[0] + u * (s_[1] / 2.0 + u * (s_[2] / 3.0 + u * s_[3] / 4.0))) +
                0.5 * params_.tangential * q.v[j] * q.v[j];
  }
  return belt_energy(q) + phi_ * sidewall + air_energy(q) + tension_.energy(q);
}

double RingMechanics::pressure(const RingField& q) const {
  const double change = share_ * std::accumulate(q.u.begin(), q.u.end(), 0.0);
  const double absolute = params_.pressure + params_.ambient;
  if (params_.gas == RingGas::linearised) return params_.pressure - absolute * change / volume_;
  return params_.pressure - absolute * change / (volume_ + change);
}

void RingMechanics::belt_gradient(const RingField& q, RingField& out) {
  with_neighbours([&](int l, int j, int r) {
    a_[j] = params_.shear * (first_ * (q.u[r] - q.u[l]) + second_ * (q.v[r] - 2.0 * q.v[j] + q.v[l]));
    b_[j] = params_.bending * (first_ * (q.v[r] - q.v[l]) - second_ * (q.u[r] - 2.0 * q.u[j] + q.u[l]));
  });
  with_neighbours([&](int l, int j, int r) {
    out.u[j] = phi_ * (first_ * (a_[l] - a_[r]) - second_ * (b_[r] - 2.0 * b_[j] + b_[l]));
    out.v[j] = phi_ * (first_ * (b_[l] - b_[r]) + second_ * (a_[r] - 2.0 * a_[j] + a_[l]));
  });
}

void RingMechanics::gradient(const RingField& q, RingField& out) {
  belt_gradient(q, out);
  // Air and the constant part of the sidewall cancel without load, so their difference is computed first.
  const double lift = share_ * (params_.pressure - pressure(q));
  for (int j = 0; j < n_; ++j) {
    const double u = q.u[j];
    out.u[j] += phi_ * u * (s_[1] + u * (s_[2] + u * s_[3])) + lift;
    out.v[j] += phi_ * params_.tangential * q.v[j];
  }
  tension_.add_gradient(q, out);
}

void RingMechanics::without_air(const RingField& q, const RingField& x, RingField& out) {
  belt_gradient(x, out);
  for (int j = 0; j < n_; ++j) {
    out.u[j] += slope(q.u[j]) * x.u[j];
    out.v[j] += phi_ * params_.tangential * x.v[j];
  }
}

void RingMechanics::tangent(const RingField& q, RingTangent& out) const {
  for (int d = 0; d < 3; ++d) {
    std::fill(out.uu[d].begin(), out.uu[d].end(), belt_[d][0]);
    std::fill(out.uv[d].begin(), out.uv[d].end(), belt_[d][1]);
    std::fill(out.vu[d].begin(), out.vu[d].end(), belt_[d][2]);
    std::fill(out.vv[d].begin(), out.vv[d].end(), belt_[d][3] + (d == 0 ? phi_ * params_.tangential : 0.0));
  }
  double sum = 0.0;
  for (int j = 0; j < n_; ++j) {
    const double u = q.u[j];
    out.uu[0][j] += slope(u);
    sum += u;
  }
  const double absolute = params_.pressure + params_.ambient, volume = volume_ + share_ * sum;
  out.gas = params_.gas == RingGas::exact ? absolute * volume_ * share_ * share_ / (volume * volume)
                                          : absolute * share_ * share_ / volume_;
  tension_.add_tangent(q, 1.0, out);
}

// A segment's sidewall pulls the rim outwards, along (sin θ, −cos θ), and in the direction of its tangential
// displacement, along (cos θ, sin θ). The part s₀ is constant around the ring and has no resultant.
RingForce RingMechanics::spindle(const RingField& q) const {
  RingForce sum;
  for (int j = 0; j < n_; ++j) {
    const double u = q.u[j], s = std::sin(j * phi_), c = std::cos(j * phi_);
    const double out = phi_ * u * (s_[1] + u * (s_[2] + u * s_[3])), after = phi_ * params_.tangential * q.v[j];
    sum.x += out * s + after * c;
    sum.z += after * s - out * c;
  }
  return sum;
}

double RingMechanics::spindle_moment(const RingField& q) const {
  double sum = 0.0;
  for (const double v : q.v) sum += v;
  return -phi_ * params_.tangential * radius_ * sum;
}

double RingMechanics::rounding(const RingField& q) const {
  double largest = 0.0;
  for (int j = 0; j < n_; ++j) largest = std::max({largest, std::abs(q.u[j]), std::abs(q.v[j])});
  const double stiffest = std::max(belt_[0][0], belt_[0][3]) + phi_ * std::abs(s_[1]) + tension_.stiffest();
  return std::numeric_limits<double>::epsilon() * stiffest * largest;
}

}  // namespace furrow::tire
