// Soil theory of a rigid wheel: sinkage, resistance and drawbar pull from Bekker's pressure–sinkage relation and Janosi
// & Hanamoto's shear law, with the contact stresses of Wong & Reece.
//
// Angles θ from the vertical, positive towards the front; entry θ₁, exit θ₂ = 0, largest pressure at θ_m.
//   σ(θ) = (k_c/b + k_φ) [R (cos θ − cos θ₁)]ⁿ                           θ_m ≤ θ ≤ θ₁
//   σ(θ) = (k_c/b + k_φ) [R (cos θ_f − cos θ₁)]ⁿ,  θ_f = θ₁ − θ (θ₁ − θ_m)/θ_m    0 ≤ θ < θ_m
//   θ_m  = (c₁ + c₂ i) θ₁                                                [Wong & Reece 1967a]
//   τ(θ) = (c + σ tan φ)(1 − exp(−j/K)),  j = R [θ₁ − θ − (1 − i)(sin θ₁ − sin θ)]
//   W = b R ∫ (σ cos θ + τ sin θ) dθ,   T = b R² ∫ τ dθ,   pull = b R ∫ (τ cos θ − σ sin θ) dθ
// b is the wheel's width, both for the stresses and as the plate width of Bekker's k.
//
// [Wong & Reece 1967a,b] Prediction of rigid wheel performance based on the analysis of soil–wheel stresses,
//   J. Terramechanics 4(1), 81–98, doi:10.1016/0022-4898(67)90105-X and 4(2), 7–25.
// [Bekker 1956] Theory of Land Locomotion. [Wong 2008] Theory of Ground Vehicles, 4th ed., §2.5.
#pragma once

namespace furrow::terrain::soil {

struct SoilStrength {
  double k_c = 0.0;       // N/m^(n+1)
  double k_phi = 0.0;     // N/m^(n+2)
  double n = 1.0;         // -
  double cohesion = 0.0;  // c, Pa
  double phi = 0.0;       // φ, rad
  double K = 0.01;        // m
};

struct RigidWheel {
  double radius = 0.0;  // R, m
  double width = 0.0;   // b, m
  double load = 0.0;    // W, N
  double c1 = 0.4;      // of θ_m [Wong & Reece 1967a: 0.43 for compact sand; 0.38 loose sand]
  double c2 = 0.2;      // [0.32 compact, 0.41 loose sand; about 0.2 for softer soils]
};

struct WheelEstimate {
  bool found = false;        // false: the soil cannot carry the wheel
  double sinkage = 0.0;      // R (1 − cos θ₁), m
  double entry_angle = 0.0;  // θ₁, rad
  double thrust = 0.0;       // b R ∫ τ cos θ dθ, N
  double resistance = 0.0;   // b R ∫ σ sin θ dθ, N
  double pull = 0.0;         // thrust − resistance, N
  double torque = 0.0;       // N m
  double pressure = 0.0;     // largest σ, Pa
};

/// The wheel at slip `slip` (1 − v/(ω R), −1 < slip ≤ 1); θ₁ is found by bisection from the load.
/// @pre all of soil and wheel finite; radius, width, load, n, K > 0; k_c/b + k_φ > 0
WheelEstimate rigid_wheel(const SoilStrength& soil, const RigidWheel& wheel, double slip);

}  // namespace furrow::terrain::soil
