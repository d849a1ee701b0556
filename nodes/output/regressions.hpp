// Traction of a wheel by published regressions, from the soil's cone index, to compare with a run's results.
//
// W load, b overall width, d diameter, h section height, δ deflection, CI cone index, s slip from the regression's own
// zero. Sources of each regression and their reliability: scripts/docs/results.md, "Regressions".
//   [Brixius 1987]   Traction prediction equations for bias ply tires, ASAE Paper 87-1622
//   [Al-Hamed 1994]  Al-Hamed, Grisso, Zoz, Von Bargen: Tractor performance spreadsheet for radial tires, Computers and
//                    Electronics in Agriculture 10
//   [Wismer 1973]    Wismer, Luth: Off-road traction prediction for wheeled vehicles, J. Terramechanics 10(2), 49–61
//   [Turnage 1972]   Tire selection and performance prediction for off-road wheeled-vehicle operations, 4th Int. Conf.
//                    ISTVS, Stockholm
//   [Mason 2016]     Mason et al.: Improved sinkage algorithms for powered and unpowered wheeled vehicles operating on
//                    sand, J. Terramechanics 67, 25–36
//   [Mason 2018]     Mason, Williams, Vahedifard, Priddy: A unified equation for predicting traction for wheels on sand
//                    over a range of braked, towed, and powered operations, J. Terramechanics 79, 33–40,
//                    doi:10.1016/j.jterra.2018.05.003
//   [Williams 2019]  Williams, Vahedifard, Mason, Priddy: New algorithms for predicting longitudinal motion resistance
//                    of wheels on dry sand, J. Defense Modeling and Simulation, doi:10.1177/1548512917693119
//   [Jazar 2008]     Vehicle Dynamics: Theory and Application, Springer
#pragma once

#include <cmath>

#include <nlohmann/json_fwd.hpp>

namespace furrow::output {

/// NaN: not known.
struct SoilWheel {
  double cone_index = NAN;      // CI, mean over the uppermost 0.15 m, Pa
  double diameter = NAN;        // d, undeformed, m
  double width = NAN;           // b, overall, m
  double section_height = NAN;  // h, from the rim to the tread, undeformed, m
  double deflection = NAN;      // δ, m; 0: a rigid wheel
  double load = NAN;            // W, N
  double slip = NAN;            // s
};

/// Forces by a regression, N; NaN if it gives none.
struct Traction {
  double gross = NAN, resistance = NAN, net = NAN;
};

/// s ≥ 0
Traction brixius_bias(const SoilWheel& wheel);
Traction brixius_radial(const SoilWheel& wheel);
/// s ≥ 0; needs neither h nor δ
Traction wismer_luth(const SoilWheel& wheel);
/// s > 0. The net traction holds at 20 % slip for any s. Gives none for a rigid wheel, whose numeric is 0.
Traction wes_sand(const SoilWheel& wheel);
/// Any s: the resistance is that of powered wheels from s = 0 on and that of towed wheels below.
Traction mason_sand(const SoilWheel& wheel);

/// Radius at which a wheel rolls without torque, m: R − δ/3, an estimate [Jazar 2008, Sect. 3.3].
inline double free_rolling_radius(double radius, double deflection) { return radius - deflection / 3.0; }
/// Rolling radius on hard ground without net pull, m: 2.5 R (R − δ)/(1.5 R + (R − δ)) [Brixius 1987].
inline double no_pull_radius(double radius, double deflection) {
  const double loaded = radius - deflection;
  return 2.5 * radius * loaded / (1.5 * radius + loaded);
}

/// The slip of one wheel, counted from two zeros other than the undeformed radius.
struct SlipZeros {
  double free_rolling = NAN, no_pull = NAN;
};

/// `regressions` of the summary; null without a cone index.
/// @param wheel its slip is not used @param cohesive if the soil is cohesive, regressions for sand are left out,
/// otherwise those for loam
nlohmann::ordered_json regressions_json(SoilWheel wheel, const SlipZeros& slip, bool cohesive);

}  // namespace furrow::output
