// Motion of grains in the engine liggghts: against free flight, and four at a time against one at a time.
#include "terrain/liggghts/plugin/grain_motion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

namespace furrow::terrain::liggghts::grain_motion_test {
namespace {

using Rows = std::vector<std::array<double, 3>>;

struct Crowd {
  Rows position, velocity, spin, force, torque;
  std::vector<double> radius;

  explicit Crowd(int count) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> draw(-1.0, 1.0);
    for (Rows* rows : {&position, &velocity, &spin, &force, &torque})
      for (int g = 0; g < count; ++g) rows->push_back({draw(random), draw(random), draw(random)});
    radius.assign(count, 0.01);
  }
  MovingGrains all() {
    const auto rows = [](Rows& of) { return reinterpret_cast<double(*)[3]>(of.data()); };
    return {rows(position), rows(velocity), rows(spin), rows(force), rows(torque), radius.data()};
  }
};

EngineSetup setup() {
  EngineSetup s;
  s.grain.mass = 0.01, s.grain.inertia = 4e-7, s.grain.radius = 0.01;
  s.gravity = {0.3, -0.2, -9.81};
  return s;
}

TEST(GrainMotion, a_kick_and_a_drift_of_each_grain_whatever_their_number) {
  for (const int count : {1, 3, 4, 5, 8, 11}) {
    Crowd crowd(count);
    const Crowd before = crowd;
    const StepTimes times{1e-3, 1e-3, 0.7e-3};
    GrainMotion motion(setup(), times);
    motion.move<true, false>(crowd.all(), count);
    double fastest2 = 0.0;
    for (int g = 0; g < count; ++g) {
      double speed2 = 0.0;
      for (int k = 0; k < 3; ++k) {
        const double v = before.velocity[g][k] + times.kick * (before.force[g][k] / 0.01 + setup().gravity[k]);
        EXPECT_DOUBLE_EQ(crowd.velocity[g][k], v);
        EXPECT_DOUBLE_EQ(crowd.spin[g][k], before.spin[g][k] + times.kick * (before.torque[g][k] / 4e-7));
        EXPECT_DOUBLE_EQ(crowd.position[g][k], before.position[g][k] + times.dt * v);
        speed2 += v * v;
      }
      fastest2 = std::max(fastest2, speed2);
    }
    EXPECT_DOUBLE_EQ(motion.fastest(), std::sqrt(fastest2)) << count;
  }
}

TEST(GrainMotion, sums_are_those_over_the_grains_where_they_are_now) {
  for (const bool sizes : {false, true}) {
    Crowd crowd(11);
    if (sizes)
      for (int g = 0; g < 11; ++g) crowd.radius[g] = 0.008 + 0.0004 * g;
    GrainMotion motion(setup(), {1e-3, 1e-3, 1e-3});
    sizes ? motion.move<true, true>(crowd.all(), 11) : motion.move<true, false>(crowd.all(), 11);
    MotionSums expected;
    for (int g = 0; g < 11; ++g) {
      const double size = crowd.radius[g] / 0.01, volume = size * size * size;
      expected.add(crowd.position[g].data(), crowd.velocity[g].data(), crowd.spin[g].data(), volume,
                   volume * size * size);
    }
    const MotionSums sums = motion.sums();
    EXPECT_NEAR(sums.volume, expected.volume, 1e-12);
    EXPECT_NEAR(sums.speed2, expected.speed2, 1e-12 * expected.speed2);
    EXPECT_NEAR(sums.spin2, expected.spin2, 1e-12 * expected.spin2);
    EXPECT_LT((sums.speed - expected.speed).norm(), 1e-12);
    EXPECT_LT((sums.place - expected.place).norm(), 1e-12);
  }
}

TEST(GrainMotion, a_grain_that_is_not_a_number_is_infinitely_fast) {
  for (const int lost : {2, 9}) {  // among four, and alone
    Crowd crowd(10);
    crowd.force[lost][1] = std::numeric_limits<double>::quiet_NaN();
    GrainMotion motion(setup(), {1e-3, 1e-3, 1e-3});
    motion.move<false, false>(crowd.all(), 10);
    EXPECT_TRUE(std::isinf(motion.fastest())) << lost;
  }
}

}  // namespace
}  // namespace furrow::terrain::liggghts::grain_motion_test
