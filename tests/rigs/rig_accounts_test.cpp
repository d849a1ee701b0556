// The drawbar rig's accounts of energy and momentum against closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "protocol/core/constants.hpp"
#include "tests/rigs/rig_fixture.hpp"

using namespace furrow;
using namespace furrow::testing;

TEST(RigAccounts, of_an_axle_that_is_held_close_and_its_rail_bears_what_the_tire_gives_beyond_the_weight) {
  rigs::DrawbarRigOptions options = reference_options();
  options.mode = "free_rolling";
  options.touchdown_time = 0.02;
  const auto rig = rigs::make_held_drawbar_rig(options, 0.05);
  rig->add_tire_mass(0, tire_mass(), kRadius);
  rig->place(std::array{0.5});
  const rigs::RigAccounts start = rig->accounts();
  const auto push = [&](int from, int to) {
    for (int i = from; i < to; ++i)
      advance(
          *rig,
          wrench(Vec3(-300.0 * std::sin(0.01 * i), 0.0, 4000.0 + 2000.0 * std::sin(0.02 * i)), Vec3(0.0, 30.0, 0.0)),
          1);
  };
  push(0, 1251);  // one step beyond 0.05 s
  const double height = rig->rim(0).position.z();
  const rigs::RigAccounts held = rig->accounts();
  EXPECT_LT(height, 0.5);  // it had begun to fall
  push(1251, 4000);
  EXPECT_NEAR(rig->rim(0).position.z(), height, 1e-12);
  EXPECT_NEAR(rig->report(0).vertical_speed, 0.0, 1e-12);
  const rigs::RigAccounts end = rig->accounts();
  // At rest in z, guide and tire carry the weight together; the guide's impulse during the fall was before that.
  EXPECT_NEAR((end.guide_impulse + end.gravity_impulse + end.tire_impulse - held.guide_impulse - held.gravity_impulse -
               held.tire_impulse)
                  .z(),
              0.0, 1e-8 * end.gravity_impulse.norm());
  EXPECT_LT(momentum_residual(start, end).norm(), 1e-8 * end.tire_impulse.norm());
  EXPECT_NEAR(energy_residual(start, end), 0.0, 1e-4 * (std::abs(end.tow_work) + std::abs(end.tire_work)));
}

TEST(RigAccounts, a_wheel_let_down_by_its_damper_loses_its_height_and_the_ground_carries_nothing) {
  rigs::DrawbarRigOptions options = reference_options();
  options.angular_speed = 0.0;
  options.touchdown_time = 1.0;
  const auto rig = placed_rig(options);
  const rigs::RigAccounts start = rig->accounts();
  advance(*rig, Wrench{}, 5000);
  const rigs::RigAccounts end = rig->accounts();
  // m ẇ = m g − c w from rest: w = w∞ (1 − e^{−t/T}), T = m/c, w∞ = g T; the loss is ∫ c w² dt.
  const double mass = carried_mass(options), c = options.touchdown_damping, time = 5000 * kStep, T = mass / c;
  const double fast = kStandardGravity * T, e = std::exp(-time / T);
  const double loss = c * fast * fast * (time - 2.0 * T * (1.0 - e) + 0.5 * T * (1.0 - e * e));
  EXPECT_NEAR(end.damper_loss / loss, 1.0, 1e-5);
  EXPECT_NEAR(end.potential_energy - start.potential_energy, -mass * kStandardGravity * fast * (time - T * (1.0 - e)),
              1e-5 * loss);
  EXPECT_NEAR(end.guide_impulse.z() + end.gravity_impulse.z(), -mass * fast * (1.0 - e), 1e-5 * mass);
  EXPECT_NEAR(energy_residual(start, end), 0.0, 1e-6 * loss);
}
