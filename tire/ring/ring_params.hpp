// Parameters of the flexible-ring tire. Parameters of a segment are given per radian of the belt, so that they do not
// depend on the number of segments.
//
// The belt is a ring of radius R and width T. Its displacements u (radial, outwards) and v (tangential) are relative to
// its inflated, circular shape. The sidewall pulls it inwards with k₁w + k₂w² + k₃w³, w = u + q, where the draw q is
// the sidewall's extension by inflation:
//   k₁q + k₂q² + k₃q³ = (1 − σ) p R T                                                                         (1)
// balances the gauge pressure p, so q is not an independent parameter. The belt carries the share σ of p R T as hoop
// tension, like a membrane. R is the radius of the inflated tire at any pressure, since a belt hardly stretches. With
// k₂ > 0 the sidewall stiffens with pressure and softens when pressed. Its force grows with w everywhere if k₂² < 3
// k₁k₃.
#pragma once

namespace furrow::tire {

/// Where a segment touches the ground: at its own angle, without its tangential displacement (radial), or at its true
/// position (exact).
enum class RingKinematics { radial, exact };
/// Law of the air: p V is constant (exact), or the tangent of this law at the inflated volume (linearised).
enum class RingGas { linearised, exact };

struct RingParams {
  int segments = 480;          // N
  double radius = 0.0;         // R, inflated, m
  double width = 0.0;          // T, m
  double air_share = 1.0;      // η: inflated volume / (π R² T)
  double pressure = 0.0;       // p, gauge, Pa
  double ambient = 101325.0;   // of the atmosphere, Pa
  double bending = 0.0;        // A, N/m per radian
  double shear = 0.0;          // B, N/m per radian
  double sidewall_1 = 0.0;     // k₁, N/m per radian
  double sidewall_2 = 0.0;     // k₂, N/m² per radian
  double sidewall_3 = 0.0;     // k₃, N/m³ per radian
  double tension_share = 0.0;  // σ, 0 to 1
  double tangential = 0.0;     // k_t, sidewall against tangential displacement, N/m per radian
  RingGas gas = RingGas::exact;
  RingKinematics kinematics = RingKinematics::exact;
};

inline constexpr int kMinSegments = 16, kMaxSegments = 20000;

/// Largest deflection in the model's range, share of the radius.
inline constexpr double kMostRingDeflection = 0.25;

/// Further parameters of a ring in motion. Two thin rings have the mass and spin inertia: the belt, m_b at R, and the
/// rest at the rim's radius ρ, which moves with the rim:
///   m_b R² + (m − m_b) ρ² = I.                                                                              (2)
struct RingMotion {
  double rim_radius = 0.0;    // ρ, m
  double mass = 0.0;          // m, kg
  double spin_inertia = 0.0;  // I, kg m²
  double damping = 0.0;       // τ of belt and sidewall, s
};

/// m_b of (2), kg. @pre m ρ² < I < m R²
double belt_mass(const RingMotion& motion, double radius);

/// Draw q of (1), m. @pre radius, width, k₁ > 0; k₂, k₃, pressure ≥ 0; σ from 0 to 1
double sidewall_draw(const RingParams& params);

}  // namespace furrow::tire
