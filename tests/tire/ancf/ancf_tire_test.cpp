// The layered tire as a whole: rigid-body limits, free flight, restart, failure.
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <string>

#include "small_tire.hpp"
#include "tests/refusal.hpp"

namespace furrow::test {
namespace {

TEST(AncfTire, free_fall_at_speed_asks_nothing_of_the_spindle_once_the_start_has_died_out) {
  tire::ShellIntegratorParams params;
  params.tolerance = 1e-8;
  RimState rim;
  rim.velocity = Vec3(4, 0, 0);
  LedTire led(rim, small_file(), params);
  const tire::AncfTire& tire = led.tire;
  const double h = 1e-4;
  for (int n = 0; n < 400; ++n) {
    led.go(rim, h);
    rim.velocity.z() -= 9.81 * h;
    rim.position += h * rim.velocity;
  }
  EXPECT_LT(tire.spindle_wrench().force.norm(), 2e-3 * tire.mass_properties().mass * 9.81);
  // The first-order rule (1) leaves a moment of h v × m g: 0.019 N m here.
  EXPECT_LT(tire.spindle_wrench().moment.norm(), 1.1 * h * 4 * tire.mass_properties().mass * 9.81);
}

TEST(AncfTire, steady_spin_asks_only_for_the_weight) {
  RimState rim;
  rim.angular_velocity = Vec3(0, 8.56, 0);
  LedTire led(rim, small_file());
  const tire::AncfTire& tire = led.tire;
  const double h = 1e-4;
  double drag = 0.0;
  for (int n = 0; n < 400; ++n) {
    led.go(rim, h);
    rim.orientation = (Quat(Eigen::AngleAxisd(8.56 * h, Vec3::UnitY())) * rim.orientation).normalized();
    if (n >= 200) drag += tire.spindle_wrench().moment.y() / 200;
  }
  EXPECT_NEAR(tire.spindle_wrench().force.z(), -9.81 * tire.mass_properties().mass, 0.5);
  EXPECT_LT(std::abs(drag),
            0.1);  // N m: hysteresis of the carcass hanging in the rim, and J Ω³ h of the method
}

TEST(AncfTire, mass_matrix_and_mass_properties_agree_for_rigid_velocity_fields) {
  tire::TireFile file = small_file();
  file.pressure = 0.0;  // undeformed
  tire::AncfTire tire(file);
  RimState rim;
  rim.position = Vec3(2, 1, 0.5);
  rim.orientation = Quat(Eigen::AngleAxisd(0.4, Vec3(1, 1, 0).normalized()));
  rim.velocity = Vec3(1, -2, 3);
  rim.angular_velocity = Vec3(0.5, 8, -0.3);
  tire.place(rim);
  const MassProperties m = tire.mass_properties();
  const Mat3 turn = rim.orientation.toRotationMatrix(), inertia = turn * m.inertia * turn.transpose();
  const auto [p, l] = momenta(tire);
  EXPECT_LT((p - m.mass * rim.velocity).norm(), 1e-12 * p.norm());
  const Vec3 expected = rim.position.cross(m.mass * rim.velocity) + inertia * rim.angular_velocity;
  EXPECT_LT((l - expected).norm(), 1e-12 * expected.norm());
  const double kinetic =
      0.5 * m.mass * rim.velocity.squaredNorm() + 0.5 * rim.angular_velocity.dot(inertia * rim.angular_velocity);
  EXPECT_NEAR(tire.diagnostics().kinetic_energy, kinetic, 1e-12 * kinetic);
}

TEST(AncfTire, inflated_tire_at_rest_hangs_its_weight_on_the_rim_along_gravity) {
  for (const Vec3& gravity : {Vec3(0.0, 0.0, -9.81), Vec3(4.0, 3.0, -8.0)}) {
    tire::ShellIntegratorParams params;
    params.gravity = gravity;
    LedTire led({}, small_file(), params);
    led.hold(600, 2e-4);
    const Vec3 off = led.tire.spindle_wrench().force - led.tire.mass_properties().mass * gravity;
    EXPECT_LT(off.norm(), 0.3);  // N
    EXPECT_LT(off.cross(gravity.normalized()).norm(), gravity.x() == 0.0 ? 0.05 : 0.3);
  }
}

TEST(AncfTire, restored_tire_continues_bit_for_bit) {
  expect_restart_bit_for_bit(small_file(), [](tire::AncfTire&, int) {});
}

/// Coordinates after rolling into contact.
tire::Field rolled(const tire::ShellIntegratorParams& params, int steps) {
  Rolling rolling(small_file(), params);
  rolling.intervals(steps);
  return rolling.tire.integrator().q();
}

TEST(AncfTire, an_old_factor_gives_the_results_of_one_renewed_in_every_step_to_1e8) {
  tire::ShellIntegratorParams old, renewed;
  old.tolerance = renewed.tolerance = 1e-10;
  renewed.age = 0.0;
  const tire::Field a = rolled(old, 200), b = rolled(renewed, 200);
  double difference = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) difference = std::max(difference, std::abs(a[k] - b[k]));
  EXPECT_LT(difference, 1e-8);
  EXPECT_GT(difference, 0.0);  // not the same path
}

TEST(AncfTire, threads_do_not_change_a_bit) {
  tire::ShellIntegratorParams one, three;
  three.threads = 3;
  EXPECT_EQ(rolled(one, 150), rolled(three, 150));
}

TEST(AncfTire, mirrored_forces_give_the_mirrored_wrench) {
  Wrench w[2];
  for (int side = 0; side < 2; ++side) {
    LedTire led({}, small_file("hmmwv_lumped.json"));
    const int rows = static_cast<int>(led.tire.integrator().layout().rows);
    NodalForces f;
    const int j = side == 0 ? 2 : rows - 3;
    f.vertex = {3 * rows + j};
    f.force = {Vec3(100, side == 0 ? 40 : -40, 300)};
    led.hold(40, 1e-4, f);
    w[side] = led.tire.spindle_wrench();
  }
  EXPECT_NEAR(w[0].force.z(), w[1].force.z(), 0.5);
  EXPECT_NEAR(w[0].force.y(), -w[1].force.y(), 0.5);
  EXPECT_NEAR(w[0].moment.y(), w[1].moment.y(), 0.3);
  EXPECT_NEAR(w[0].moment.x(), -w[1].moment.x(), 0.3);
}

TEST(AncfTire, a_blow_that_cannot_be_integrated_is_a_status_with_advice) {
  LedTire led({}, small_file());
  Outcome status;
  for (int n = 0; n < 5 && status.ok; ++n) status = led.advance({}, 1e-3, {{3}, {Vec3(0, 0, 1e12)}});
  EXPECT_FALSE(status.ok);
  const std::string message = status.message("tire 0", " at t = 0.1 s, step 7");
  EXPECT_EQ(message.rfind("tire 0 did not converge at t = 0.1 s, step 7: residual ", 0), 0u) << message;
  EXPECT_TRUE(holds(message, "; try "));
}

TEST(AncfTire, pressed_on_a_plane_it_carries_350_to_800_newtons_per_millimetre) {
  Rolling rolling(small_file("hmmwv_layered.json", 48, 12), {}, 0.0, 0.010);
  rolling.step = 2e-4;
  rolling.intervals(500);
  const double load = rolling.tire.spindle_wrench().force.z();
  double sunk = 0.0;
  for (const Vec3& x : rolling.surface().position) sunk = std::max(sunk, -x.z());
  const double deflection = rolling.depth - 0.5 * sunk;  // minus about half the penalty ground's deflection
  EXPECT_GT(load / deflection, 350e3);
  EXPECT_LT(load / deflection, 800e3);
}

}  // namespace
}  // namespace furrow::test
