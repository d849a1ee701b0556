// Corner under the belt, (2): with x(s, q) = x_c and x, z linear in q at a given s,
//   g = z(s(q), q) − z_c,   ∂g = z_q − m x_q,   m = z_s / x_s,   s_q = −x_q / x_s,
//   ∂²g = l s_qᵀ + s_q lᵀ + (z_ss − m x_ss) s_q s_qᵀ,   l = z_qs − m x_qs.
#include "tire/ring/ring_contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "protocol/core/assert.hpp"

namespace furrow::tire {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kHidden = 1e-9;  // m, by which another face may be in front of a visible corner
constexpr double kNear = 0.02;    // of the radius: largest gap that is kept
constexpr double kFound = 1e-10;  // of the radius: tolerance along the belt for a corner's place under it

}  // namespace

struct RingContact::Belt {
  int first;  // of the three segments
  double x, z, x_s, z_s, x_ss, z_ss;
  std::array<double, 6> x_q, z_q, x_qs, z_qs;

  /// @param turns from straight down, in segments
  Belt(const RingContact& ring, const RingField& q, double turns) {
    const double middle = std::round(turns), s = turns - middle, angle = turns * ring.phi_;
    first = ring.wrapped(static_cast<int>(middle) - 1);
    const Weights w = weights(s);
    const double round_x = ring.radius_ * std::sin(angle), round_z = -ring.radius_ * std::cos(angle);
    x = round_x, z = round_z, x_s = -ring.phi_ * round_z, z_s = ring.phi_ * round_x;
    x_ss = -ring.phi_ * ring.phi_ * round_x, z_ss = -ring.phi_ * ring.phi_ * round_z;
    for (int i = 0; i < 3; ++i) {
      const int j = ring.after(first, i);
      const double sine = ring.sine_[j], cosine = ring.cosine_[j];
      const double dx = q.u[j] * sine + q.v[j] * cosine, dz = q.v[j] * sine - q.u[j] * cosine;
      x += w.share[i] * dx, z += w.share[i] * dz;
      x_s += w.slope[i] * dx, z_s += w.slope[i] * dz;
      x_ss += w.bend[i] * dx, z_ss += w.bend[i] * dz;
      x_q[2 * i] = w.share[i] * sine, x_q[2 * i + 1] = w.share[i] * cosine;
      z_q[2 * i] = -w.share[i] * cosine, z_q[2 * i + 1] = w.share[i] * sine;
      x_qs[2 * i] = w.slope[i] * sine, x_qs[2 * i + 1] = w.slope[i] * cosine;
      z_qs[2 * i] = -w.slope[i] * cosine, z_qs[2 * i + 1] = w.slope[i] * sine;
    }
  }

  /// Weights of the three displacements in (1), and their derivatives.
  struct Weights {
    std::array<double, 3> share, slope, bend;
  };
  static Weights weights(double s) {
    return {{0.5 * (0.5 - s) * (0.5 - s), 0.75 - s * s, 0.5 * (0.5 + s) * (0.5 + s)},
            {s - 0.5, -2.0 * s, s + 0.5},
            {1.0, -2.0, 1.0}};
  }
};

RingContact::RingContact(const RingMechanics& ring, const RingGround& ground)
    : ground_(ground), kinematics_(ring.params().kinematics), radius_(ring.radius()), phi_(ring.angle()) {
  for (int j = 0; j < ring.segments(); ++j) {
    sine_.push_back(std::sin(j * phi_));
    cosine_.push_back(std::cos(j * phi_));
  }
  ray_.resize(sine_.size());
  corner_ray_.resize(ground_.corners().size());
}

void RingContact::place(const AxlePlace& axle) {
  axle_ = axle;
  if (kinematics_ == RingKinematics::exact) return;
  for (int j = 0; j < segments(); ++j)
    ray_[j] = reaches_down(j) ? ground_.distance(axle.x, axle.z, std::atan2(sine_[j], cosine_[j])) : kInfinite;
  for (std::size_t k = 0; k < corner_ray_.size(); ++k) {
    const double x = ground_.corners()[k].x - axle.x, z = ground_.corners()[k].z - axle.z;
    const double angle = std::atan2(x, -z), rho = std::hypot(x, z);
    const bool seen = std::cos(angle) > kSteepest && !(ground_.distance(axle.x, axle.z, angle) < rho - kHidden);
    corner_ray_[k] = seen ? rho : kInfinite;
  }
}

GroundPoint RingContact::position(const RingField& q, int j) const {
  const double r = radius_ + q.u[j];
  return {r * sine_[j] + q.v[j] * cosine_[j], q.v[j] * sine_[j] - r * cosine_[j]};
}

SegmentGap RingContact::segment(const RingField& q, int j) const {
  if (!reaches_down(j)) return {.gap = kInfinite};
  if (kinematics_ == RingKinematics::radial) return {ray_[j] - radius_ - q.u[j], -1.0, 0.0, -sine_[j], cosine_[j]};
  const GroundPoint p = position(q, j);
  const int face = ground_.face(p.x + axle_.x);
  if (face < 0) return {.gap = kInfinite};
  const double m = ground_.slope(face);
  return {p.z + axle_.z - ground_.height(face, p.x + axle_.x), -cosine_[j] - m * sine_[j], sine_[j] - m * cosine_[j],
          -m, 1.0};
}

bool RingContact::corners(const RingField& q, std::vector<CornerGap>& out) const {
  for (int k = 0; k < static_cast<int>(corner_ray_.size()); ++k) {
    if (!(std::abs(ground_.corners()[k].x - axle_.x) < radius_)) continue;
    if (static_cast<int>(out.size()) == kMostCornerGaps) return false;
    if (kinematics_ == RingKinematics::radial)
      radial_corner(q, k, out);
    else
      exact_corner(q, k, out);
    // If a step crosses a gap that is left out here, the next step contains it.
    if (!out.empty() && out.back().corner == k && out.back().gap > kNear * radius_) out.pop_back();
  }
  return true;
}

void RingContact::radial_corner(const RingField& q, int k, std::vector<CornerGap>& out) const {
  if (!(corner_ray_[k] < kInfinite)) return;
  const GroundPoint& c = ground_.corners()[k];
  const double turns = std::atan2(c.x - axle_.x, axle_.z - c.z) / phi_, middle = std::round(turns);
  const Belt::Weights w = Belt::weights(turns - middle);
  CornerGap gap;
  gap.corner = k, gap.first = wrapped(static_cast<int>(middle) - 1);
  gap.gap = corner_ray_[k] - radius_, gap.share = w.share;
  for (int i = 0; i < 3; ++i) {
    const int j = after(gap.first, i);
    gap.gap -= w.share[i] * q.u[j], gap.slope[2 * i] = -w.share[i];
    gap.push_x -= w.share[i] * sine_[j], gap.push_z += w.share[i] * cosine_[j];
  }
  out.push_back(gap);
}

void RingContact::exact_corner(const RingField& q, int k, std::vector<CornerGap>& out) const {
  const double at = ground_.corners()[k].x - axle_.x;
  double turns = std::asin(at / radius_) / phi_;
  constexpr int kMostIterations = 30;
  for (int i = 0; i < kMostIterations; ++i) {  // the belt's point over the corner: x grows smoothly along it
    const Belt belt(*this, q, turns);
    const double change = (at - belt.x) / belt.x_s;
    turns += change;
    if (!(std::abs(turns) < 0.2 * segments())) return;
    if (std::abs(change) < 1e-14 * segments()) break;
  }
  const Belt p(*this, q, turns);
  if (!(p.x_s > 0.0 && std::abs(p.x - at) < kFound * radius_)) return;
  const double m = p.z_s / p.x_s, curl = p.z_ss - m * p.x_ss;
  CornerGap gap;
  gap.corner = k, gap.first = p.first;
  gap.gap = p.z + axle_.z - ground_.corners()[k].z;
  gap.push_x = -m, gap.push_z = 1.0, gap.share = Belt::weights(turns - std::round(turns)).share;
  std::array<double, 6> s_q, l;
  for (int i = 0; i < 6; ++i) {
    gap.slope[i] = p.z_q[i] - m * p.x_q[i];
    s_q[i] = -p.x_q[i] / p.x_s;
    l[i] = p.z_qs[i] - m * p.x_qs[i];
  }
  for (int i = 0; i < 6; ++i)
    for (int o = 0; o < 6; ++o) gap.bend[6 * i + o] = l[i] * s_q[o] + s_q[i] * l[o] + curl * s_q[i] * s_q[o];
  out.push_back(gap);
}

}  // namespace furrow::tire
