// Prints error rates of the statistics in nodes/output for many synthetic series, as CSV: how often a drift is found in
// stationary and in drifting series, and how far the standard error is from the true one.
//
// usage: steadiness_rates [TRIALS]
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "tests/nodes/synthetic_series.hpp"

namespace {

using furrow::testing::Drift;
using furrow::testing::drift_found;
using furrow::testing::halves_apart;
using furrow::testing::Process;
using furrow::testing::Trials;

constexpr std::size_t kSamples = 800;  // as of rigs/drawbar_pull_small_report_soil.json

double share(const Trials& trials, const auto& is) {
  return static_cast<double>(std::count_if(trials.each.begin(), trials.each.end(), is)) /
         static_cast<double>(trials.each.size());
}

double percentile(const Trials& trials, double at, const auto& of) {
  std::vector<double> values;
  for (const auto& one : trials.each) values.push_back(of(one));
  const auto place = static_cast<std::ptrdiff_t>(at * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + place, values.end());
  return values[static_cast<std::size_t>(place)];
}

/// Columns of one kind of series, in order.
std::vector<std::pair<const char*, double>> figures(const Process& process, int trials) {
  const Trials t = furrow::testing::run_trials(process, trials, 1);
  const auto ratio = [&](const auto& s) { return s.sem / t.true_sem; };
  const auto samples = [](const auto& s) { return s.n_eff; };
  const auto power = [&](Drift drift, double sigmas, auto test) {
    return furrow::testing::share_found(process, drift, t.true_sem, sigmas, trials, test);
  };
  double mean_ratio = 0.0;
  for (const auto& s : t.each) mean_ratio += ratio(s) / trials;
  return {{"n_eff", process.n_eff},
          {"trials", trials},
          {"drift_found", share(t, drift_found)},
          {"halves_apart", share(t, halves_apart)},
          {"line_2_sigma", power(Drift::line, 2.0, drift_found)},
          {"line_3_sigma", power(Drift::line, 3.0, drift_found)},
          {"line_4_sigma", power(Drift::line, 4.0, drift_found)},
          {"line_6_sigma", power(Drift::line, 6.0, drift_found)},
          {"line_6_sigma_halves_apart", power(Drift::line, 6.0, halves_apart)},
          {"step_6_sigma", power(Drift::step, 6.0, drift_found)},
          {"decay_6_sigma", power(Drift::decay, 6.0, drift_found)},
          {"sem_over_true", mean_ratio},
          {"sem_over_true_16", percentile(t, 0.16, ratio)},
          {"sem_over_true_84", percentile(t, 0.84, ratio)},
          {"mean_within_1.96_sem", share(t, [](const auto& s) { return std::abs(s.mean) <= 1.96 * s.sem; })},
          {"n_eff_estimated", percentile(t, 0.5, samples)},
          {"n_eff_estimated_10", percentile(t, 0.1, samples)},
          {"n_eff_estimated_90", percentile(t, 0.9, samples)}};
}

void row(const Process& process, int trials) {
  static bool first = true;
  const auto columns = figures(process, trials);
  if (first) {
    std::printf("process");
    for (const auto& [name, unused] : columns) std::printf(",%s", name);
    first = false;
  }
  std::printf("\n%s", process.name);
  for (const auto& [unused, value] : columns) std::printf(",%.4g", value);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const int trials = argc > 1 ? std::atoi(argv[1]) : 4000;
  std::puts("# compiler: g++ " __VERSION__);
  for (const double n_eff : {6.0, 8.0, 10.0, 12.0, 15.0, 20.0, 30.0, 40.0, 60.0}) {
    row(furrow::testing::autoregressive_of(n_eff, kSamples), trials);
    row(furrow::testing::moving_average_of(n_eff, kSamples), trials);
  }
  for (const double bounces : {3.0, 5.0, 8.0})
    row({bounces == 3.0   ? "bouncing_3"
         : bounces == 5.0 ? "bouncing_5"
                          : "bouncing_8",
         0.0, [=](std::mt19937_64& e) { return furrow::testing::bouncing(kSamples / bounces, 0.2, kSamples, e); }},
        trials);
  std::printf("\n");
  return 0;
}
