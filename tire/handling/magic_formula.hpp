// The Magic Formula, steady state: forces and moments of a tire that rolls on hard ground.
//
//   y = D sin[C atan{B x − E (B x − atan(B x))}]
//
// References: [1] H. B. Pacejka, Tire and Vehicle Dynamics, 3rd edition, Butterworth-Heinemann 2012, section 4.3.2,
// equations (4.E1) to (4.E78); 2nd edition 2006 alike. [2] TNO Automotive, MF-Tyre User Manual 5.2, 2001. [3] I. J. M.
// Besselink, A. J. C. Schmeitz, H. B. Pacejka, An improved Magic Formula/Swift tyre model that can handle inflation
// pressure changes, Vehicle System Dynamics 48 S1 (2010) 337–352. [4] MSC Software, Adams/Tire: Using the PAC2002 tire
// model.
//
// Magic Formula 6.1 is that of the book without turn slip (ζ = 1), without the decay of friction with sliding speed
// (λ_μV = 0, A_μ = 1), with these equations of [3], where the book's differ: the trail D_t by QDZ3 γ* in place of |γ*|,
// B_t by QBZ4 γ* and QBZ5 |γ*|, M_x with QSX6 inside of the square, and M_y with F_z0 in place of F_z. 6.2 differs in
// the loaded radius alone, of which the terms of camber, speed and tangential force are left out, as in 6.1.
//
// Version 5.2 [2] differs from the book in these places:
//   - camber enters as the angle γ, in K_yα by |γ|, and in S_Hy, S_Vy by PHY3, PVY3, PVY4 in place of K_yγ0;
//   - μ = (p_D1 + p_D2 df_z)(1 − p_D3 γ²);
//   - M_x and M_y are linear in F_y, γ and F_x, of M_y (4.E70) with QSY3, QSY4 of the forward speed;
//   - the trail's force is F_y − S_Vyκ with its camber, in place of that without.
// PAC2002 [4] is 5.2 with the terms of dp_i = p/p_0 − 1, which are those of the book, and with QSX4 to QSX11 and QSY5
// to QSY8; there M_y is in proportion to F_z (F_z/F_z0)^QSY7.
//
// A file with FE_METHOD = 'YES', or without coefficients of combined slip (RBX1 or RCX1, RBY1 or RCY1 are 0), gets the
// friction ellipse of [4]: with κ_c = κ + S_Hx + S_Vx/K_x, s = sin(α + S_Hy + S_Vy/K_y) and the pure forces F_x0, F_y0,
//
//   F_x = F_x0 |κ_c|/√(κ_c² + (s F_x0/D_y)²),   F_y = F_y0 |s|/√(s² + (κ_c F_y0/D_x)²)
//
// which lie within the ellipse of D_x and D_y, go to the pure forces for small slips, and slide along the slip.
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

/// Of 6.1 with stiffnesses in [STRUCTURAL]: σ_κ = K_xκ/C_Fx, σ_α = |K_yα|/C_Fy,
/// C_Fx = C_x (1 + PCFX1 df_z + PCFX2 df_z²)(1 + PCFX3 dp_i), C_Fy alike [3]. Otherwise
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

/// dp_i = (p − p_0)/p_0, (4.E2b), p_0 = LIP NOMPRES; 0 where a file does not say both pressures.
double pressure_change(const MagicFormula& tire);

/// Whether combined slip follows the friction ellipse, along and across.
bool ellipse_along(const MagicFormula& tire);
bool ellipse_across(const MagicFormula& tire);

/// The spring of the wheel's plane without camber: [DEFLECTION_LOAD_CURVE] by straight lines, its last slope beyond it;
/// or F = (1 + PFZ1 dp_i) F_z0 [Q_FZ1 ρ/R_0 + Q_FZ2 (ρ/R_0)²], (4.E68) without speed and tangential forces; a file that
/// does not say Q_FZ1 has √((C_z R_0/F_z0)² − 4 Q_FZ2), so that the slope under F_z0 is C_z [3]. LCZ scales either.
/// @param deflection ρ, m @return N, 0 where nothing is pressed
double spring_force(const MagicFormula& tire, double deflection);
/// ∫ F dρ, J.
double spring_energy(const MagicFormula& tire, double deflection);
/// @param load ≥ 0, N @return ρ, m
double spring_deflection(const MagicFormula& tire, double load);
/// Of the cylinder of R_0 flattened by FNOMIN, m.
double contact_length(const MagicFormula& tire);
/// dF/dρ under the load, N/m.
double spring_stiffness(const MagicFormula& tire, double load);

/// R_e = R_0 − (F_z0/C_z)[D atan(B ρ_d) + F ρ_d], ρ_d = ρ C_z/F_z0 [2], of 6.1 F_z/F_z0 [3], m. @param deflection ρ, m
double rolling_radius(const MagicFormula& tire, double deflection);

}  // namespace furrow::tire::handling
