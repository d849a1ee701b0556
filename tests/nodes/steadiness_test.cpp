// Which means are steady. References: Student's t distribution for the share of stationary series in which a drift is
// found; the conditions one by one.
#include <gtest/gtest.h>

#include <cmath>

#include "nodes/output/steadiness.hpp"
#include "tests/nodes/synthetic_series.hpp"

namespace furrow {
namespace {

constexpr std::size_t kSamples = 800;
constexpr int kTrials = 1500;

/// The whole table is tests/studies/steadiness.csv.
TEST(Drift, is_found_in_one_of_forty_stationary_series_with_enough_independent_samples) {
  const double scatter = std::sqrt(output::kDriftLevel * (1.0 - output::kDriftLevel) / kTrials);
  for (const double n_eff : {20.0, 60.0})
    for (const testing::Process& process :
         {testing::autoregressive_of(n_eff, kSamples), testing::moving_average_of(n_eff, kSamples)}) {
      const double found = testing::share_found(process, testing::Drift::line, 0.0, 0.0, kTrials, testing::drift_found);
      EXPECT_NEAR(found, output::kDriftLevel, 3.0 * scatter) << process.name << " n_eff " << n_eff;
    }
}

TEST(Steadiness, every_broken_condition_is_said_in_words) {
  output::SeriesStatistics pull, sinkage;
  pull.sem = 50.0;
  pull.std = 200.0;
  pull.n_eff = 16.0;
  pull.drift.change = 90.0;
  sinkage.drift.change = 0.0007;
  const output::SteadyWindow good{4609.0, 0.028, 0.25, 0.9, 1.9, 0.4673, true};
  EXPECT_TRUE(output::unsteady_because(pull, sinkage, good).empty());

  output::SteadyWindow bad = good;
  bad.duration = 0.7;
  EXPECT_EQ(output::unsteady_because(pull, sinkage, bad).size(), 1u);
  bad.travel = 0.9;
  EXPECT_EQ(output::unsteady_because(pull, sinkage, bad).size(), 2u);
  bad.whole_facets = false;
  EXPECT_EQ(output::unsteady_because(pull, sinkage, bad).size(), 3u);
  pull.sem = 93.0;  // 2 % of the load is 92.18 N
  EXPECT_EQ(output::unsteady_because(pull, sinkage, bad).size(), 4u);
  pull.drift.found = true;
  EXPECT_EQ(output::unsteady_because(pull, sinkage, bad).size(), 5u);
  sinkage.drift.found = true;
  EXPECT_EQ(output::unsteady_because(pull, sinkage, bad).size(), 6u);
  pull.n_eff = 9.9;
  EXPECT_EQ(output::unsteady_because(pull, sinkage, bad).size(), 7u);
}

/// k = κ W/z and T = 2π √(m/k): the wheel of a laboratory bounces faster than that of a truck.
TEST(Steadiness, the_bounce_period_follows_from_what_tire_and_soil_give_under_the_load) {
  const double deep = output::bounce_period(0.028, 9.81), shallow = output::bounce_period(0.007, 9.81);
  EXPECT_NEAR(deep / shallow, 2.0, 1e-12);
  EXPECT_NEAR(deep, 0.25, 0.03);
  EXPECT_EQ(output::bounce_period(-0.01, 9.81), 0.0);
  EXPECT_EQ(output::bounce_period(std::nan(""), 9.81), 0.0);
  const output::SteadyWindow small{24.5, 0.007, shallow, 0.5, 0.2, 0.058, true};
  EXPECT_TRUE(output::unsteady_because({}, {}, small).empty());
}

/// On hard ground everything decays smoothly towards its limit: the rest at the end is found, but does not matter.
TEST(Steadiness, small_drifts_and_few_samples_of_a_pull_that_hardly_varies_count_for_nothing) {
  output::SeriesStatistics pull, sinkage;
  pull.drift.found = sinkage.drift.found = true;
  pull.drift.change = 22.0;  // 0.5 % of the load is 23 N
  sinkage.drift.change = 0.0005;
  pull.n_eff = 3.0;
  pull.std = 20.0;
  const output::SteadyWindow window{4609.0, 0.028, 0.25, 0.9, 1.9, 0.4673, true};
  EXPECT_TRUE(output::unsteady_because(pull, sinkage, window).empty());
  pull.drift.change = -24.0;
  EXPECT_EQ(output::unsteady_because(pull, sinkage, window).size(), 1u);
  sinkage.drift.change = 0.0006;
  EXPECT_EQ(output::unsteady_because(pull, sinkage, window).size(), 2u);
}

}  // namespace
}  // namespace furrow
