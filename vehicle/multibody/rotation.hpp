// Rotations on SO(3): exponential map, and the angular velocity over a step from the angular momentum.
#pragma once

#include <cmath>

#include "protocol/core/assert.hpp"
#include "protocol/core/vec.hpp"

namespace furrow::vehicle {

/// exp([θ]×) as unit quaternion; θ rotation vector, rad.
inline Quat rotation_exp(const Vec3& theta) {
  const double angle_sq = theta.squaredNorm();
  double c, s;  // cos(|θ|/2), sin(|θ|/2)/|θ|
  if (angle_sq < 1e-6) {
    // Series to |θ|⁶: the next term is below 1e-27.
    c = 1.0 - angle_sq / 8.0 * (1.0 - angle_sq / 48.0 * (1.0 - angle_sq / 120.0));
    s = 0.5 * (1.0 - angle_sq / 24.0 * (1.0 - angle_sq / 80.0 * (1.0 - angle_sq / 168.0)));
  } else {
    const double angle = std::sqrt(angle_sq);
    c = std::cos(0.5 * angle);
    s = std::sin(0.5 * angle) / angle;
  }
  return Quat(c, s * theta.x(), s * theta.y(), s * theta.z());
}

/// exp(h [ω]×) q, normalised.
inline Quat rotated(const Quat& q, const Vec3& omega_W, double h) {
  Quat result = rotation_exp(h * omega_W) * q;
  result.normalize();
  return result;
}

/// Computes the constant angular velocity ω over a step h whose momentum at mid-step is ℓ:
///   R½ J R½ᵀ ω = ℓ,  R½ = exp(h/2 [ω]×) R₀.
/// In body axes W = R₀ᵀω: J W = exp(−h/2 [W]×) R₀ᵀℓ, by fixed-point iteration (contracts for h|ω| < 1).
/// @return false when the iteration does not settle.
inline bool midpoint_angular_velocity(const Mat3& R, const Mat3& inertia_inverse, const Vec3& momentum_W, double h,
                                      Vec3& omega_W) {
  FURROW_ASSERT(h >= 0.0, h);
  const Vec3 L = R.transpose() * momentum_W;
  Vec3 W = inertia_inverse * L;
  for (int i = 0; i < 60; ++i) {
    const Vec3 next = inertia_inverse * (rotation_exp(-0.5 * h * W) * L);
    const double change = (next - W).cwiseAbs().maxCoeff();
    W = next;
    if (change <= 1e-15 * W.cwiseAbs().maxCoeff()) {
      omega_W = R * W;
      return true;
    }
  }
  omega_W = R * W;
  // Two neighbouring floating-point values may alternate; the iteration has then settled too.
  const Vec3 next = inertia_inverse * (rotation_exp(-0.5 * h * W) * L);
  return (next - W).cwiseAbs().maxCoeff() <= 1e-13 * W.cwiseAbs().maxCoeff();
}

/// Computes ω for a body that carries rotors of momentum p (body axes), which turn with it:
///   R½ (J R½ᵀ ω + p) = ℓ + R₀ p,   so   J W = exp(−h/2 [W]×) (R₀ᵀℓ + p) − p.
inline bool midpoint_angular_velocity(const Mat3& R, const Mat3& inertia_inverse, const Vec3& momentum_W,
                                      const Vec3& rotor, double h, Vec3& omega_W) {
  FURROW_ASSERT(h >= 0.0, h);
  const Vec3 L = R.transpose() * momentum_W + rotor;
  Vec3 W = inertia_inverse * (L - rotor);
  double before = 0.0;
  for (int i = 0; i < 200; ++i) {
    const Vec3 next = inertia_inverse * (rotation_exp(-0.5 * h * W) * L - rotor);
    const double change = (next - W).cwiseAbs().maxCoeff();
    const double size = W.cwiseAbs().maxCoeff() + (inertia_inverse * rotor).cwiseAbs().maxCoeff();
    W = next;
    omega_W = R * W;
    // The difference of two large momenta has reached round-off when it no longer falls.
    if (change <= 1e-15 * size || (i > 2 && change <= 1e-13 * size && change >= before)) return true;
    before = change;
  }
  return false;
}

}  // namespace furrow::vehicle
