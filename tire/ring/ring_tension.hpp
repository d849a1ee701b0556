// Hoop tension of an inflated belt: the geometric stiffness of a ring under the pressure inside.
//
// The belt carries a share σ of the pressure p like a membrane. Its hoop tension H = σ p R T is constant around the
// ring, for any shape of the belt. With the length L and the enclosed area A of the polygon of segments,
//   Π_t = H cos(φ/2) (L − L₀) − σ p T (A − A₀)
//       = σ p T Σ R cos(φ/2) e − ½ (u u₊ + v v₊) sin φ − ½ (u v₊ − v u₊) cos φ,                                    (1)
//   e = n²/(l + l₀ + a),   l² = (l₀ + a)² + n²,   l₀ = 2 R sin(φ/2),                                            (2)
//   n = (u₊ − u) cos(φ/2) − (v₊ + v) sin(φ/2),   a = (u₊ + u) sin(φ/2) + (v₊ − v) cos(φ/2),
// where + marks the next segment; a and n are the stretch of a chord and its turn away from the circle's. Terms of
// first order cancel: the circle is exactly in balance, as H cos(φ/2) is the tension of a polygon. Rigid motions of any
// size are free, since L and A do not change. To second order, as φ → 0,
//   Π_t = ½ σ p T ∫ (u'² − u²) dθ:                                                                             (3)
// the pressure follows the belt, and v drops out. A wave of the order n has the stiffness σ p T (n² − 1) per radian
// [the terms in σ_θ⁰ and p₀ of Gong 1993, A study of in-plane dynamics of tires, TU
// Delft, ch. 3, with σ_θ⁰ A = p₀ b R].
#pragma once

#include "tire/ring/ring_field.hpp"

namespace furrow::tire {

class RingTension {
 public:
  RingTension(int segments, double radius);

  /// σ p T, N/m.
  void set(double strength) { strength_ = strength; }
  /// Approximate largest entry of the tangent, N/m.
  double stiffest() const;

  double energy(const RingField& q) const;
  void add_gradient(const RingField& q, RingField& out) const;
  /// Adds factor × the tangent.
  void add_tangent(const RingField& q, double factor, RingTangent& out) const;

 private:
  struct Chord {
    double turn, along, length;  // n, l₀ + a, l
  };
  Chord chord(const RingField& q, int j, int next) const;

  int n_;
  double sine_, cosine_, sine_2_, cosine_2_;  // of φ/2, φ
  double chord_, line_;                       // l₀, R cos(φ/2), m
  double strength_ = 0.0;
};

}  // namespace furrow::tire
