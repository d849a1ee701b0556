// The mean of a correlated series and how well it is known.
#pragma once

#include <span>

namespace furrow {

struct SeriesStatistics {
  double mean = 0.0;
  double std = 0.0;        // of the samples
  double sem = 0.0;        // standard error of the mean, std / √n_eff
  double n_eff = 0.0;      // number of independent samples, n / τ_int
  double drift = 0.0;      // slope of the least-squares line, per sample interval
  bool halves_agree = false;  // |mean of first half − of second| ≤ 2√2 · sem
};

/// τ_int = 1 + 2 Σ ρ(k), summed up to the first lag M ≥ 5 τ_int(M) (automatic windowing).
/// Source: Sokal (1997), "Monte Carlo Methods in Statistical Mechanics", Eqs. (3.13), (3.17),
/// doi:10.1007/978-1-4899-0319-8_6. With fewer than 4 samples sem is infinite.
SeriesStatistics statistics(std::span<const double> samples);

}  // namespace furrow
