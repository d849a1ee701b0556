// The Magic Formula, steady state, as of MF-Tyre 5.2: forces and moments of a tire that rolls on hard level ground.
//
//   y = D sin[C atan{B x − E (B x − atan(B x))}]
//
// References: [1] H. B. Pacejka, Tire and Vehicle Dynamics, 3rd edition, Butterworth-Heinemann 2012, section 4.3.2,
// equations (4.E1) to (4.E78); 2nd edition 2006 alike. Version 5.2 lacks the book's terms of inflation pressure and of
// turn slip (ζ = 1), and differs from it in these places [2: TNO Automotive, MF-Tyre User Manual 5.2, 2001]:
//   - camber enters as the angle γ, in K_yα by |γ|, and in S_Hy, S_Vy by PHY3, PVY3, PVY4 in place of K_yγ0;
//   - μ = (p_D1 + p_D2 df_z)(1 − p_D3 γ²), without the decay of friction with sliding speed;
//   - M_x and M_y are linear in F_y, γ and F_x, of M_y (4.E70) with QSY3, QSY4 of the forward speed;
//   - the trail uses the factors QDZ3, QDZ4 of γ, in place of the book's QDZ3 to QDZ11 of |γ|.
//
// Signs (ISO 8855, the W-axes of TYDEX; tire/wheel_axes.hpp): x forward, y left, z up at the contact centre. F and M
// act on the tire. tan α = V_sy/|V_cx|, κ = −V_sx/|V_cx|, γ about x: positive α, γ give a negative F_y (PKY1 < 0),
// positive κ drives. A positive QSY1 resists: M_y < 0 while the wheel rolls forward. Files of the adapted SAE axes of
// [1] have PKY1 > 0, and are not meant.
#pragma once

#include "tire/handling/coefficients.hpp"

namespace furrow::tire::handling {

struct SlipState {
  double load = 0.0;        // F_z, N
  double slip = 0.0;        // κ, -
  double slip_angle = 0.0;  // α, rad
  double camber = 0.0;      // γ, rad
  double speed = 0.0;       // V_cx, m/s, of the rolling moment
};

/// On the tire, about the contact centre, W-axes.
struct HandlingForces {
  double fx = 0.0, fy = 0.0, fz = 0.0;  // N
  double mx = 0.0, my = 0.0, mz = 0.0;  // N m
  double slip_stiffness = 0.0;          // K_xκ, N
  double cornering_stiffness = 0.0;     // K_yα, N/rad; negative in these axes
};

/// Forces at the state, held within the file's ranges: beyond one of slips or camber its end counts, beyond one of
/// loads the forces go on in proportion to the load. No load gives no force. @pre all of the state is finite
HandlingForces evaluate(const MagicFormula& tire, const SlipState& state);

/// Without the ranges: what the formula itself says. @pre load > 0
HandlingForces evaluate_formula(const MagicFormula& tire, const SlipState& state);

/// σ_κ = F_z (p_Tx1 + p_Tx2 df_z) exp(−p_Tx3 df_z) R_0/F_z0,
/// σ_α = p_Ty1 sin[2 atan(F_z/(p_Ty2 F_z0))] (1 − p_Ky3 |γ|) R_0 [2],
/// m; 0 where the file has none.
struct RelaxationLengths {
  double longitudinal = 0.0, lateral = 0.0;
};
/// @pre load ≥ 0
RelaxationLengths relaxation_lengths(const MagicFormula& tire, double load, double camber);

/// The formula on a ground of the friction μ: λ_μx and λ_μy are scaled so that the peaks at the nominal load without
/// camber, |p_Dx1| λ_μx and |p_Dy1| λ_μy, are at most μ. A smaller peak stays, and so do the slip stiffnesses.
/// @pre friction ≥ 0
MagicFormula on_ground_of(MagicFormula tire, double friction);

/// R_e = R_0 − (F_z0/C_z)[D atan(B ρ_d) + F ρ_d], ρ_d = ρ C_z/F_z0 [2], m. @param deflection ρ, m
double rolling_radius(const MagicFormula& tire, double deflection);

}  // namespace furrow::tire::handling
