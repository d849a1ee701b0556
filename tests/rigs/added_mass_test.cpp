// The rim carries the tire's rigid-body mass, so a wrench that arrives late contains no inertia. With a tire of three
// times the rim's inertia, free spin-up and drop stay exact.
#include <gtest/gtest.h>

#include "protocol/core/constants.hpp"
#include "tests/rigs/rig_fixture.hpp"

using namespace furrow;
using namespace furrow::testing;

TEST(AddedMass, free_spin_up_and_drop_are_exact_with_three_times_the_rims_inertia) {
  rigs::DrawbarRigOptions options = steady_options();
  options.mode = "free_rolling";
  options.speed = 0.0;
  options.carrier_mass = 1.0;
  MassProperties tire;
  tire.mass = 3.0 * (options.rim_mass + options.carrier_mass);
  tire.inertia = 3.0 * Vec3(options.rim_diametral_inertia, options.rim_spin_inertia, options.rim_diametral_inertia)
                           .asDiagonal()
                           .toDenseMatrix();
  const auto rig = placed_rig(options, tire);
  // A rigid tire in the air exerts its whole wrench minus its own inertia and weight: only the external moment on it.
  const double moment = 5.0, total = 4.0 * options.rim_spin_inertia;
  for (int i = 1; i <= 2000; ++i) {
    advance(*rig, wrench(Vec3::Zero(), Vec3(0, moment, 0)), 1);
    const double t = i * kStep;
    ASSERT_NEAR(rig->rim(0).angular_velocity.y(), moment * t / total, 1e-12) << i;
    ASSERT_NEAR(rig->rim(0).velocity.z(), -kStandardGravity * t, 1e-12) << i;
  }
  EXPECT_NEAR(rig->rim(0).position.z(), 0.5 - 0.5 * kStandardGravity * 0.08 * 0.08, 1e-12);
}

TEST(AddedMass, wheel_falls_along_its_slider_and_the_drive_holds_it_on_a_slope) {
  rigs::DrawbarRigOptions options = steady_options();
  options.mode = "free_rolling";
  options.speed = 0.0;
  options.gravity = Vec3(2.0, 0.0, -9.0);
  const auto rig = placed_rig(options, MassProperties{});
  advance(*rig, wrench(Vec3::Zero()), 2000);
  const double t = 2000 * kStep, mass = rig->report(0).carried_mass + options.chassis_mass + options.set_toe_mass;
  EXPECT_NEAR(rig->rim(0).velocity.z(), -9.0 * t, 1e-10);
  EXPECT_NEAR(measured(*rig, "drawbar_pull_raw_N"), mass * 2.0, 1e-8 * mass);
  EXPECT_EQ(rig->report(0).gravity, options.gravity);
}

// A lagging tire computes its complete wrench from the rim motion of the previous interval and subtracts its rigid-body
// part of the same interval, as in the exchange. The difference vanishes for a rigid tire.
TEST(AddedMass, a_lagged_complete_wrench_less_its_inertia_is_stable) {
  rigs::DrawbarRigOptions options = steady_options();
  options.mode = "free_rolling";
  options.speed = 0.0;
  MassProperties tire = tire_mass(3.0 * options.rim_spin_inertia / kTireSpin);
  const auto rig = placed_rig(options, tire);
  const Vec3 gravity(0, 0, -kStandardGravity);
  RimState before = rig->rim(0);
  Wrench sent;
  for (int i = 1; i <= 2000; ++i) {
    ASSERT_TRUE(rig->advance({&sent, 1}, kStep, 1).ok);
    const RimState now = rig->rim(0);
    const Vec3 acceleration = (now.velocity - before.velocity) / kStep;
    const Vec3 spin_up = (now.angular_velocity - before.angular_velocity) / kStep;
    const double ground = 1000.0, drive = 4.0;  // the terrain pushes the tire up and turns it
    const Wrench complete = {Vec3(0, 0, ground) - tire.mass * (acceleration - gravity),
                             Vec3(0, drive, 0) - tire.inertia * spin_up};
    sent.force = complete.force + tire.mass * (acceleration - gravity);
    sent.moment = complete.moment + tire.inertia * spin_up;
    before = now;
  }
  const double mass = rig->report(0).carried_mass, t = 1999 * kStep;  // the first interval had no wrench
  EXPECT_NEAR(rig->rim(0).velocity.z(), 1000.0 / mass * t - kStandardGravity * 2000 * kStep, 1e-10);
  EXPECT_NEAR(rig->rim(0).angular_velocity.y(), 4.0 * t / (4.0 * options.rim_spin_inertia), 1e-10);
}
