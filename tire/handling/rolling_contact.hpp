// How a handling tire stands and slips on hard ground: what the Magic Formula needs of the rim's motion, with
// slips that follow it over a relaxation length.
//
// With the W-axes of tire/wheel_axes.hpp at the contact centre C, the loaded radius R_l and the camber angle γ:
//
//   deflection ρ = R_0 − R_l,   F_z = (F(ρ) + K_z ρ̇)/cos γ ≥ 0,   F = C_z ρ or as the file says (spring_force())
//
// On uneven ground the W-axes are those of the plane of road_plane.hpp. F_z acts at C: so ∫ F dρ is a potential, and
// what the ground does not get back of F_z's work is K_z ρ̇².
//
//   V_C = v + (ω − Ω a) × (C − r),   V_sx = V_Cx − Ω R_e(ρ),   V_sy = V_Cy,   Ω the spin about the axle a
//   u̇ = −V_sx − |V_Cx| u/σ_κ,   v̇ = −V_sy − |V_Cx| v/σ_α                     [1, chapter 7: (7.7), (7.9)]
//   κ' = u/σ_κ − D V_sx/K_xκ,   tan α' = −v/σ_α
//
// u, v are the deflections of the contact patch against the rim; they stay within what the file's ranges of slip allow,
// so that a spinning or sliding wheel does not wind them up. They are integrated exactly for a constant motion, and at
// rest they are springs: a tire holds its place on a slope. D damps these springs below VXLOW, and fades with the
// cosine of the speed, after [1, chapter 8]; it is a tenth of the critical damping of the mass that F_z carries.
// Sideways likewise. The formula holds for a wheel that rolls forward; one that rolls backward is seen from the other
// side, half a turn about z away, and between ± VXLOW both count in proportion. Rolling resistance is whole from 0.01
// m/s on. A file without relaxation lengths takes κ = −V_sx/max(|V_Cx|, VXLOW).
//
// Reference: [1] H. B. Pacejka, Tire and Vehicle Dynamics, 3rd edition, 2012.
#pragma once

#include "protocol/core/fields.hpp"
#include "tire/handling/magic_formula.hpp"
#include "tire/handling/road_plane.hpp"
#include "tire/wheel_axes.hpp"

namespace furrow::tire::handling {

/// Deflections of the contact patch, m; 0 in the air.
struct PatchState {
  double along = 0.0, across = 0.0;
};
void visit_fields(FieldsOf<PatchState> auto& s, auto&& visit) {
  visit(s.along, Field{"along", "m"});
  visit(s.across, Field{"across", "m"});
}

/// What the rim's motion is to the contact.
struct ContactMotion {
  WheelAxes axes;
  double deflection = 0.0;            // ρ, m; not above 0: in the air
  double rate = 0.0;                  // ρ̇, m/s
  double load = 0.0;                  // F_z, N
  double travel = 0.0;                // V_Cx, m/s
  double slip_x = 0.0, slip_y = 0.0;  // V_sx, V_sy, m/s
};

ContactMotion contact_motion(const MagicFormula& tire, const RimState& rim, const RoadPlane& road = {});

/// The patch after `duration` of such a motion. @pre duration ≥ 0, s
PatchState advanced(const MagicFormula& tire, const ContactMotion& motion, const PatchState& patch, double duration);

/// On the tire, about the contact centre.
HandlingForces contact_forces(const MagicFormula& tire, const ContactMotion& motion, const PatchState& patch);

}  // namespace furrow::tire::handling
