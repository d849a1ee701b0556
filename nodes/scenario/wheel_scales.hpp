// Size of a wheel compared with its grains, bed and walls, and its speed compared with gravity and pressure, before any
// model is made. These figures separate a result from an artefact of the bin. They are estimates, only for `furrow
// validate`.
//
// Sinkage z of a rigid wheel (R, b, W, d = 2 R) that slips by s.
//
// On sand of known cone index CI, the mean over the upper 0.15 m, under a wheel at least as wide, it follows from the
// motion resistance of rigid wheels [Brixius 1987]. A uniform pressure on the contact in front of the axle, of length
// ℓ = √(2 R z), has a resultant of slope z/ℓ = √(z/d), so
//   √(z/d) = 1/B_n + s/(2 √B_n),   B_n = CI b d/W / (1 + 3 b/d)
// The regression is for loam. On LETE sand (340 kPa, 4.6 kN) it gives 8, 11, 19, 28 and 38 mm at a slip of 0, 0.1, 0.3,
// 0.5 and 0.7, where runs sank by 0, 4, 14, 28 and 48 (tests/studies/lete_sand_slip.csv). There bearing capacity gives
// 51 mm: it counts neither the dilation of a dense bed nor the size of its grains.
//
// Otherwise it follows from a strip footing's bearing capacity [Terzaghi 1943; N_γ of Vesić 1973]:
//   W = b ℓ (c N_c + γ z N_q + ½ γ min(b, ℓ) N_γ)
// with the strength that soil tests of this program found for its grains: φ = 26° (26.5 ± 1.0° at friction 0.9, 26.8 ±
// 0.7° at 0.5 with rolling friction 0.2, 34 ± 2° with 0.5), c = 0.08 × the contact cohesion (6.8 ± 1.4 kPa at 80 kPa).
// A denser bed is stronger: 30.2 ± 1.6° at a solid fraction of 0.6 with friction 0.5 and rolling friction 0.1; such
// grains fall to 0.56 (tests/studies/packing.csv, calibrated_lete_sand.csv).
// Compared with runs of the reference wheel, 4.6 kN: 15 mm at 80 kPa (runs: 15 to 20 mm, 30 mm on a bed twice as deep),
// 42 mm at 40 kPa (35), 80 mm at 20 kPa (77 on a deep bed).
//
// [Brixius 1987] ASAE Paper 87-1622. [Terzaghi 1943] Theoretical Soil Mechanics, ch. 8. [Vesić 1973] J. Soil Mech.
// Found. Div. ASCE 99(1), 45–73.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "nodes/scenario/scenario.hpp"

namespace furrow::scenario {

struct WheelScales {
  double load = 0.0;            // W, N
  double froude = 0.0;          // v/√(g R) at full speed, v the faster of axle and tread
  double lowering_needs = 0.0;  // s until the load is carried, with rig.move_from; 0: not needed

  struct OnGrains {
    double sinkage = 0.0;          // z, m
    bool by_cone_index = false;    // it follows from the soil's cone index
    double contact_length = 0.0;   // ℓ, m
    double pressure = 0.0;         // W/(b ℓ), Pa
    double grains_wide = 0.0;      // tread width in grain diameters
    double grains_long = 0.0;      // contact length in grain diameters
    double reach = 0.0;            // sinkage, with grousers that of their tips, m
    double depth_ratio = 0.0;      // bed height over reach
    std::optional<double> beside;  // from the wheel to the nearest side wall, m; none: periodic
    double ahead = 0.0;            // from the wheel to the end wall at the end of its travel, m
    double near_end = 0.0;         // share of the averaging window in which the end wall is within reach
    double inertial = 0.0;         // I = γ̇ d √(ρ/p), with the slip speed over a band of 10 d
    double impact = 0.0;           // ρ w² over the pressure, w the speed at which the rim enters the soil
  };
  std::optional<OnGrains> grains;
};

/// Load of each wheel at rest, with the tire's own weight, N.
std::vector<double> wheel_loads(const Scenario& scenario);

std::vector<WheelScales> wheel_scales(const Scenario& scenario);

/// A scale that binds the answer, and its known effect.
struct Bound {
  std::string key;  // of the scenario, that changes it
  std::string what;
  std::vector<std::string> wheels = {};  // affected wheels, by name; none if the rig has one wheel
};
std::vector<Bound> scale_bounds(const Scenario& scenario);

/// Name in results: "front_left", "wheel 2".
std::string wheel_name(const rigs::RigDescription& rig, std::size_t wheel);
/// Label of a wheel among several; empty if there is only one.
std::string wheel_label(const rigs::RigDescription& rig, std::size_t wheel);

/// Largest communication step before the timing of forces at a wheel's contact affects the result.
///
/// A tire with a motion of its own gets its forces one step late, which adds energy to it. Its own damping must be
/// faster, so H ≤ share × τ (TireDescription). Prompt forces (Scenario::prompt) are those of springs under a leapfrog
/// rule: H ≤ 1/(2 ω) with the fastest of
///   bounce  ω² = k/m     k of a rigid wheel on its ground, or of a handling tire; m the tire and what moves with it
///   spin    ω² = K R²/(σ I)   of a handling tire: slip stiffness K over its relaxation length σ
struct CouplingStep {
  double step = std::numeric_limits<double>::infinity();  // s
  std::string because;                                    // "the spin of its wheel on the tire's grip"
};

std::vector<CouplingStep> coupling_steps(const Scenario& scenario);
CouplingStep smallest_coupling_step(const Scenario& scenario);
/// Other remedies, for users: ", or tire.contact_tangent"; empty: none.
std::string other_help(const Scenario& scenario);

}  // namespace furrow::scenario
