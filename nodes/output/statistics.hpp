// The mean of a correlated series and how well it is known.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace furrow::output {

struct SeriesStatistics {
  double mean = 0.0;
  double std = 0.0;           // of the samples
  double sem = 0.0;           // standard error of the mean, std / √n_eff
  double n_eff = 0.0;         // number of independent samples, n / τ_int
  double drift = 0.0;         // slope of the least-squares line, per sample interval
  bool halves_agree = false;  // |mean of first half − of second| ≤ 2√2 · sem
};

/// τ_int = [1 + 2 Σ ρ(k)] (1 + (2M + 1)/n), summed up to the first lag M ≥ 5 τ_int(M) (automatic windowing);
/// the second factor undoes the bias from subtracting the sample's own mean.
/// Sources: Sokal (1997), "Monte Carlo Methods in Statistical Mechanics", doi:10.1007/978-1-4899-0319-8_6, section 3;
/// Wolff (2004), Comput. Phys. Commun. 156, 143, doi:10.1016/S0010-4655(03)00467-3.
/// With fewer than 4 samples sem is infinite.
SeriesStatistics statistics(std::span<const double> samples);

/// What a steady mean is judged by, besides its statistics.
struct SteadyWindow {
  double load = 0.0;           // weight on the wheel, N
  double bounce_period = 0.0;  // s; 0: not known
  double duration = 0.0;       // s
  double travel = 0.0;         // of the axle or of the tread, whichever is longer, m
  double radius = 0.0;         // undeformed tire radius, m
  bool whole_facets = false;  // the window holds a whole number of tire facets, within one line of the series
};

/// Period in which a loaded wheel bounces on its tire and soil, s: T = 2π √(m/k) = 2π √(z/(κ g)) with k = κ W/z. z is
/// what tire and soil give under the load W, sinkage and deflection together, m. κ = 1.9 is how much stiffer they are
/// about that state than W/z: rigs/drawbar_pull_small.json without its touch-down damper bounces with 0.25 s (minima of
/// the axle's height at 0.166, 0.434 and 0.663 s) at z = 28 mm. A force that goes with depth^1.5, as of a Hertz contact
/// or of a wheel on soil with p ∝ z [Bekker 1956], gives 1.5; soil that unloads is stiffer. 0 where z is not positive.
double bounce_period(double settlement, double gravity);

/// Why a mean over this window is not steady, in words; empty when it is: halves agree within 2√2 · sem, sem at most
/// 2 % of the load, at least 3 bounce periods, 2 radii of travel, a whole number of facets.
std::vector<std::string> unsteady_because(const SeriesStatistics& pull, const SteadyWindow& window);

}  // namespace furrow::output
