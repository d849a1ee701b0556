// Parameters of terramechanics from measured curves. Every fit is plain algebra on arrays, without units or files.
// Stresses and pressures are positive in compression; sinkage and travel are positive.
//
// [Wong 2008] J. Y. Wong, Theory of Ground Vehicles, 4th ed., Wiley, §2.4.
// [Janosi & Hanamoto 1961] The analytical determination of drawbar pull as a function of slip for tracked vehicles,
//   Proc. 1st Int. Conf. Mechanics of Soil–Vehicle Systems, Turin.
#pragma once

#include <span>
#include <vector>

namespace furrow::terrain::soil {

struct Measured {
  double value = 0.0;
  double standard_error = 0.0;  // NaN if there is only one sample
  int samples = 0;              // from which the error was computed
  double freedom = 0.0;         // degrees of freedom of that error
  /// Half the width of the 95 % confidence interval: Student's t × standard error; NaN without an error.
  double half_interval() const;
};

/// Mean of independent samples and its standard error. @pre at least one sample
Measured mean_of(std::span<const double> samples);

struct PlateCurve {
  double width = 0.0;            // b, the smaller side or the radius of a disc [Wong 2008], m
  std::vector<double> sinkage;   // z > 0, m
  std::vector<double> pressure;  // p > 0, Pa
};

/// p = k zⁿ for each plate, one n for all, k_i = k_c/b_i + k_φ.
struct BekkerFit {
  double n = 0.0;
  double k_c = 0.0;       // N/m^(n+1)
  double k_phi = 0.0;     // N/m^(n+2)
  double goodness = 0.0;  // 1 − Σ(p − p_fit)²/Σ(p − p̄)² over all plates; at most 1
  std::vector<double> k;  // of each plate, Pa/mⁿ
};
/// Weighted least squares of ln p = ln k_i + n ln z with weights p² [Wong 2008]. These weights minimise the error of
/// the pressure itself, not that of its logarithm. Points with z ≤ 0 or p ≤ 0 are left out.
/// @pre two plates or more of different widths, each with two usable points or more
BekkerFit fit_bekker(std::span<const PlateCurve> plates);

/// p = k zⁿ for plates of one size, by the same least squares.
struct PowerFit {
  double n = 0.0;
  double k = 0.0;  // Pa/mⁿ
};
/// @pre one plate or more of the same width, each with two usable points or more
PowerFit fit_power(std::span<const PlateCurve> plates);

/// τ = τ_max (1 − exp(−j/K)).
struct JanosiFit {
  double tau_max = 0.0;   // Pa
  double K = 0.0;         // m
  double goodness = 0.0;  // 1 − Σ(τ − τ_fit)²/Σ(τ − τ̄)²
};
/// Least squares: τ_max follows from K, which is searched between the smallest travel and ten times the largest.
/// @pre three points or more
JanosiFit fit_janosi(std::span<const double> travel, std::span<const double> stress);

/// τ = c + σ tan φ.
struct CoulombFit {
  Measured cohesion;      // Pa
  Measured tan_phi;       // -
  Measured phi;           // rad
  double goodness = 0.0;  // R²
};
/// Least-squares line with standard errors from the scatter about it. @pre two different σ or more
CoulombFit fit_coulomb(std::span<const double> normal, std::span<const double> shear);

/// τ = σ tan φ, for soil without cohesion: least squares, with the error of φ in rad from the scatter about the line.
/// @pre one value or more, some σ above 0
Measured fit_friction(std::span<const double> normal, std::span<const double> shear);

/// Straight line y = a + s x.
struct Line {
  double offset = 0.0, slope = 0.0;
};
/// @pre two points or more
Line fit_line(std::span<const double> x, std::span<const double> y);

}  // namespace furrow::terrain::soil
