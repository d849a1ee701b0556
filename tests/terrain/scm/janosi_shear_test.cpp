// Shear of a node of empirical soil against Janosi & Hanamoto's closed form.
#include "terrain/scm/janosi_shear.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace furrow::terrain::scm {
namespace {

constexpr ShearLaw kSand{.cohesion = 1300.0, .tan_phi = 0.6, .K = 0.012, .friction = 0.9};

TEST(JanosiShear, is_the_closed_form_for_any_step_and_any_history_of_pressure) {
  const Vec3 v(0.03, -0.04, 0.0);
  for (const int steps : {1, 7, 1000}) {
    Vec3 m = Vec3::Zero();
    for (int k = 0; k < steps; ++k) shear(kSand, v, 0.5 / steps, m);
    const double expected = -std::expm1(-0.05 * 0.5 / kSand.K);
    EXPECT_NEAR((m - expected * v / 0.05).norm(), 0.0, 1e-13) << steps;
  }
}

TEST(JanosiShear, the_limit_is_mohr_coulombs_or_the_surfaces_own) {
  EXPECT_DOUBLE_EQ(kSand.limit(50e3), 1300.0 + 30e3);
  EXPECT_DOUBLE_EQ(kSand.limit(1e3), 900.0);  // c would hold more than rubber does
  EXPECT_EQ(kSand.limit(0.0), 0.0);
}

TEST(JanosiShear, work_is_stored_or_lost_by_sliding) {
  // To and fro and across: ∫ τ·v dt = Δ stored + τ_max ∫ |m|² |v| dt, exactly for any step.
  Vec3 m = Vec3::Zero();
  const double limit = kSand.limit(40e3);
  double work = 0.0, lost = 0.0;
  for (const Vec3& v : {Vec3(0.2, 0.0, 0.0), Vec3(-0.2, 0.0, 0.0), Vec3(0.0, 0.1, 0.05), Vec3(-0.3, 0.2, 0.0)})
    for (int k = 0; k < 10; ++k) {
      const double dt = 0.01;
      const ShearStep step = shear(kSand, v, dt, m);
      work += limit * step.mean.dot(v) * dt;
      EXPECT_GE(step.sliding, 0.0);
      lost += limit * step.sliding;
      EXPECT_LE(m.norm(), 1.0);
      EXPECT_NEAR((lost + kSand.stored(limit, m)) / work, 1.0, 1e-12);
    }
}

TEST(JanosiShear, turns_over_the_same_length_on_reversal) {
  Vec3 m = Vec3::Zero();
  shear(kSand, Vec3(1.0, 0.0, 0.0), 1.0, m);
  EXPECT_NEAR(m.x(), 1.0, 1e-12);
  shear(kSand, Vec3(-1.0, 0.0, 0.0), kSand.K * std::log(2.0), m);
  EXPECT_NEAR(m.x(), 0.0, 1e-12);
  shear(kSand, Vec3::Zero(), 1.0, m);
  EXPECT_NEAR(m.x(), 0.0, 1e-12);  // at rest nothing changes
}

}  // namespace
}  // namespace furrow::terrain::scm
