// Heaps: a column of grains between frictionless side walls collapses along a rough floor. Law mindlin comes to rest at
// an angle that grows with rolling resistance and with friction; law hertz_tanh has no rest.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "protocol/core/constants.hpp"
#include "tests/terrain/verification/engine_grains.hpp"
#include "tests/verification/record.hpp"

namespace furrow::verification::repose_test {
namespace {

using terrain::dem::GrainSolver;

constexpr double kRadius = 0.006;  // m
constexpr double kWidth = 0.05;    // m, four grains
constexpr double kStep = 4e-5;     // s
constexpr int kAlong = 6, kAcross = 4, kUp = 15;

/// A loose column against the wall x = 0.
terrain::dem::GrainSolver column(EngineGrains& few) {
  few.options.length = 1.5;
  few.options.width = kWidth;
  few.options.step = kStep;
  few.gravity = kStandardGravity;
  terrain::dem::Uniform even(7);
  const auto any = [&] { return 2e-4 * even(); };
  std::vector<terrain::dem::Quad> at;
  for (int k = 0; k < kUp; ++k)
    for (int i = 0; i < kAlong; ++i)
      for (int j = 0; j < kAcross; ++j)
        at.push_back({0.0064 + 0.0125 * i + any(), 0.0125 * (j - 0.5 * (kAcross - 1)) + any(),
                      0.0064 + 0.0125 * k + any(), 0.0});
  terrain::dem::GrainSolver s = few.make(at);
  terrain::dem::SolverCoefficients k = few.coefficients();
  EngineGrains smooth = few;
  smooth.options.friction = smooth.options.rolling_friction = 0.0;
  k.side = smooth.coefficients().side;
  s.set_coefficients(k);
  return s;
}

void run(terrain::dem::GrainSolver& s, double time) { terrain::dem::run(s, kStep, std::lround(time / kStep)); }

/// Slope of the line through the highest grains of vertical slices, from 15 to 85 % of the heap's height, degrees.
double angle_of(const terrain::dem::GrainSolver& s) {
  constexpr double kSlice = 2.0 * kRadius;
  std::vector<double> top(200, 0.0);
  for (int g = 0; g < s.grains().count; ++g) {
    const terrain::dem::Quad& x = s.grains().position[g];
    double& highest = top[std::min<std::size_t>(199, static_cast<std::size_t>(x.x / kSlice))];
    highest = std::max(highest, x.z);
  }
  const double height = *std::max_element(top.begin(), top.end());
  double n = 0.0, sx = 0.0, sz = 0.0, sxx = 0.0, sxz = 0.0;
  for (int k = 0; k < 200; ++k) {
    if (top[k] > 0.85 * height || top[k] < 0.15 * height) continue;
    const double x = (k + 0.5) * kSlice;
    n += 1.0, sx += x, sz += top[k], sxx += x * x, sxz += x * top[k];
  }
  return -std::atan((n * sxz - sx * sz) / (n * sxx - sx * sx)) * 180.0 / M_PI;
}

double mean_height(const terrain::dem::GrainSolver& s) { return s.accounts().height / s.grains().count; }

struct Heap {
  double angle = 0.0;    // degrees
  double height = 0.0;   // mean, m
  double sinking = 0.0;  // of the mean height within the last 0.2 s, relative
};

/// After 1.8 s.
Heap heap(double friction, double rolling, double young = 2.49e7) {
  EngineGrains few;
  few.options.friction = friction;
  few.options.rolling_friction = rolling;
  few.options.young_modulus = young;
  terrain::dem::GrainSolver s = column(few);
  run(s, 1.6);
  const double before = mean_height(s);
  run(s, 0.2);
  return {angle_of(s), mean_height(s), 1.0 - mean_height(s) / before};
}

const std::string kZhou = "Zhou et al. 2001 doi:10.1103/PhysRevE.64.021301";

TEST(Repose, angle_grows_with_rolling_and_sliding_friction_as_zhou_2001_found) {
  const std::string name = "collapsed column, mindlin";
  Worst rest(name, "sinking of the mean height in 0.2 s, relative", 1e-3, "static friction holds a heap");
  double before = 0.0;
  int growing = 0;
  for (const double rolling : {0.05, 0.1, 0.2, 0.4}) {
    const Heap now = heap(0.5, rolling);
    rest.add(now.sinking, 0.0, 1.0, "mu_r = " + brief(rolling));
    growing += before > 0.0 && now.angle > before + 1.0;
    before = now.angle;
    RecordProperty("angle_at_rolling_friction_" + brief(rolling), brief(now.angle));
  }
  verify(name, "times the angle grows from mu_r = 0.05 to 0.1, 0.2, 0.4", growing, 3.0, 0.0, kZhou);
  EXPECT_GT(before, 20.0);
  EXPECT_LT(before, 45.0);

  const Heap smooth = heap(0.2, 0.2), rough = heap(0.5, 0.2);
  EXPECT_GT(rough.angle, smooth.angle + 3.0);
  verify(name, "ratio of angles, mu = 0.5 by 0.2, is above 1", rough.angle / smooth.angle > 1.0, 1.0, 0.0, kZhou);
  const Heap soft = heap(0.5, 0.2, 1e7);
  verify(name, "mean height with a modulus of 1e7 by 2.5e7", soft.height / rough.height, 1.0, 0.1,
         kZhou + ": hardly any influence of the modulus");
}

TEST(Repose, hertz_tanh_heap_flows_on) {
  EngineGrains few;
  few.options.law = "hertz_tanh";
  few.options.friction = 0.9;
  few.options.rolling_friction = 0.2;
  terrain::dem::GrainSolver s = column(few);
  run(s, 1.5);
  const double early = mean_height(s), angle = angle_of(s);
  run(s, 1.5);
  // Waiting until it is flat takes too long; a change by a tenth in the same time again is not rest.
  EXPECT_LT(angle_of(s), angle);
  EXPECT_LT(mean_height(s), 0.9 * early);
  verify("collapsed column, hertz_tanh", "mean height sinks by over 10 % from 1.5 to 3 s", mean_height(s) < 0.9 * early,
         1.0, 0.0, "no static friction: creep at any slope");
}

}  // namespace
}  // namespace furrow::verification::repose_test
