// Energy, force and tangent of the flexible ring without contact: belt, sidewall and air.
//
// N segments at the angles θ_j = jφ, φ = 2π/N, with displacements u_j, v_j from the inflated circle of radius R. With
// the differences
//   D₁f_j = (f_{j+1} − f_{j−1}) / (2 sin φ),   D₂f_j = (f_{j+1} − 2f_j + f_{j−1}) / (2 (1 − cos φ)),              (1)
// which are exact for sin θ and cos θ, the energy is
//   Π = φ Σ ½A (D₁v − D₂u)² + ½B (D₁u + D₂v)²                                     belt                        (2)
//     + φ Σ ∫₀ᵘ (s₀ + s₁u + s₂u² + s₃u³) du + ½ k_t v²                             sidewall                    (3)
//     − p₀V₀ ln(V/V₀) + p_a (V − V₀),   V = V₀ + RφT Σu,   V₀ = η π R² T           air                         (4)
//     + Π_t                                          hoop tension of the belt, (1) of ring_tension.hpp
// A resists the change of the belt's curvature, (v − u')'. B resists shear between its plies, which is proportional to
// the gradient of the hoop strain, (u + v')' (shear lag). B → ∞ is the inextensible ring, whose bending energy is ½A
// (u'' + u)². The belt's null space, also with (1), has exactly four dimensions: both translations (u, v) = (cos θ,
// −sin θ) and (sin θ, cos θ), the rotation v = 1, and the uniform growth u = 1. No alternating mode is free. The
// sidewall resists translations and growth. Only k_t > 0 resists the rotation: its torsional stiffness is 2π R² k_t.
//
// (3) is the sidewall's polynomial in w = u + q about the draw q (ring_params.hpp), with s₀ = p R T, p = p₀ − p_a. The
// sidewall carries (1 − σ) p R T and the belt's tension the share σ, so the inflated ring is exactly in balance. With σ
// = 0 the belt has no hoop tension, and the sidewall carries the whole resultant of the pressure. σ > 0 leaves rigid
// motions free and resists waves of the orders n ≥ 2.
//
// The air `linearised` has the second-order expansion of (4). The tangent of either kind of air is a constant times the
// outer product of (1, …, 1) on u with itself. This matrix of rank one is kept separately (RingTangent::gas).
#pragma once

#include <array>
#include <vector>

#include "tire/ring/ring_field.hpp"
#include "tire/ring/ring_params.hpp"
#include "tire/ring/ring_tension.hpp"

namespace furrow::tire {

/// Force on the rim by the tire, or on the belt by the ground, N.
struct RingForce {
  double x = 0.0, z = 0.0;  // forward, up
};

class RingMechanics {
 public:
  /// @pre as for sidewall_draw(); segments ≥ kMinSegments, ambient, air_share > 0
  explicit RingMechanics(const RingParams& params);

  int segments() const { return n_; }
  double angle() const { return phi_; }      // of a segment, φ
  double radius() const { return radius_; }  // R, m
  double draw() const { return draw_; }      // q, m
  double volume() const { return volume_; }  // inflated, V₀, m³
  const RingParams& params() const { return params_; }
  const RingTension& tension() const { return tension_; }

  /// Gauge pressure of the inflated ring from now on, Pa.
  void set_pressure(double pressure);

  RingField zero() const;
  RingTangent no_tangent() const;  // zero, of the right size
  /// Π, J; 0 when inflated and unloaded.
  double energy(const RingField& q) const;
  /// ∂Π/∂q. @pre the volume is positive
  void gradient(const RingField& q, RingField& out);
  /// The air's part of Π, J.
  double air_energy(const RingField& q) const;
  /// Tangent at q of belt and sidewall, without air and hoop tension, times x. Structural damping acts on this part.
  void without_air(const RingField& q, const RingField& x, RingField& out);
  /// Tangent of all parts; the air's part is separate, in RingTangent::gas.
  void tangent(const RingField& q, RingTangent& out) const;
  /// Gauge pressure, Pa.
  double pressure(const RingField& q) const;
  /// Tangent of one segment's sidewall, N/m.
  double slope(double u) const { return phi_ * (s_[1] + u * (2.0 * s_[2] + 3.0 * s_[3] * u)); }
  /// Force of the sidewall on the rim, N.
  RingForce spindle(const RingField& q) const;
  /// Moment of the tangential springs on the rim about +y, N m.
  double spindle_moment(const RingField& q) const;
  /// Round-off of an entry of the gradient, N: the round-off of the belt's stiffness times the largest displacement.
  double rounding(const RingField& q) const;

 private:
  double belt_energy(const RingField& q) const;
  /// Gradient of (2).
  void belt_gradient(const RingField& q, RingField& out);
  /// Calls visit(before, j, after) for all segments; its inner loop has no modulo.
  template <class Visit>
  void with_neighbours(Visit visit) const {
    visit(n_ - 1, 0, 1);
    for (int j = 1; j < n_ - 1; ++j) visit(j - 1, j, j + 1);
    visit(n_ - 2, n_ - 1, 0);
  }

  RingParams params_;
  int n_;
  double phi_, draw_ = 0.0, radius_, volume_;
  double first_, second_;  // 1 / (2 sin φ), 1 / (2 (1 − cos φ))
  double share_;           // RφT, m²
  RingTension tension_;
  std::array<double, 4> s_;                    // of (3), per radian
  std::array<std::array<double, 4>, 3> belt_;  // uu, uv, vu, vv of the belt's blocks d = 0, 1, 2
  std::vector<double> a_, b_;                  // of belt_gradient(): B (D₁u + D₂v), A (D₁v − D₂u)
};

}  // namespace furrow::tire
