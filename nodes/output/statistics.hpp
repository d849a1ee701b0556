// The mean of a correlated series, its standard error, and whether it drifts.
#pragma once

#include <span>

namespace furrow::output {

/// Tests whether a series drifts over its window: compares its slowest change with slightly faster ones.
///
/// For a stationary series whose correlation is short compared with the window, the sums
///   C(j) = √(2/n) Σ x(i) cos(π j (i + ½)/n),  j = 1, 2, …
/// are independent and normal with the same variance, n · sem² [Müller 2007]. A drift appears in C(1), half a wave over
/// the window: C(1) contains 99 % of a straight line's Σ over j of C(j)² and 81 % of that of a step in the middle.
/// Therefore
///   t = C(1) / √(mean of C(2)² … C(ν + 1)²)
/// has Student's t distribution with ν degrees of freedom. A drift enlarges the standard error of the whole window, so
/// it can hide from a test with that error, but not from this one.
/// Sources: Müller (2007), J. Econometrics 141, 1331, doi:10.1016/j.jeconom.2007.02.002; Lazarus, Lewis, Stock & Watson
/// (2018), J. Bus. Econ. Stat. 36, 541, doi:10.1080/07350015.2018.1506926, for the cosines and Student's t.
struct DriftTest {
  double change = 0.0;  // mean of the second half less mean of the first
  double t = 0.0;
  bool found = false;  // |t| is larger than in 97.5 % of stationary series
};

inline constexpr int kDriftCosines = 4;       // ν
inline constexpr double kDriftLevel = 0.025;  // share of stationary series in which the test finds a drift

struct SeriesStatistics {
  double mean = 0.0;
  double std = 0.0;    // of the samples
  double sem = 0.0;    // standard error of the mean, std / √n_eff
  double n_eff = 0.0;  // number of independent samples, n / τ_int
  double slope = 0.0;  // of the least-squares line, per sample interval
  DriftTest drift;
};

/// τ_int = [1 + 2 Σ ρ(k)] (1 + (2M + 1)/n), summed up to the first lag M ≥ 5 τ_int(M) (automatic windowing). The second
/// factor corrects the bias from subtracting the sample's own mean.
/// Sources: Sokal (1997), "Monte Carlo Methods in Statistical Mechanics", doi:10.1007/978-1-4899-0319-8_6, section 3;
/// Wolff (2004), Comput. Phys. Commun. 156, 143, doi:10.1016/S0010-4655(03)00467-3.
/// With fewer than 4 samples sem is infinite; with fewer than 2 (ν + 1) no drift is found.
SeriesStatistics statistics(std::span<const double> samples);

}  // namespace furrow::output
