// The rigid tire against Newton's and Euler's equations.
#include "tire/rigid/rigid_tire.hpp"
#include "tire/ancf/shell_spec.hpp"
#include "tire/read_tire_file.hpp"

#include <gtest/gtest.h>

#include "tests/saved.hpp"
#include "tests/tire/led_tire.hpp"

namespace furrow::tire {
namespace {

using Led = test::Led<RigidTire>;

Led led(const RimState& start = {}, const Vec3& gravity = standard_gravity()) {
  TireFile file = read_tire_file(TIRE_DATA "/hmmwv_layered.json");
  file.elements_circumference = 24;
  set_elements_width(file, 6);
  return Led(start, shell_shape(file), gravity);
}

TEST(RigidTire, free_drop_and_free_spin_ask_nothing_of_the_spindle) {
  RimState rim;
  rim.angular_velocity = Vec3(0, 8.56, 0);
  Led wheel = led(rim);
  const double h = 1e-4;
  for (int n = 0; n < 100; ++n) {
    wheel.go(rim, h);
    const Wrench last = wheel.tire.spindle_wrench();
    rim.velocity.z() -= 9.81 * h;
    rim.position += h * rim.velocity;
    rim.orientation = (Quat(Eigen::AngleAxisd(8.56 * h, Vec3::UnitY())) * rim.orientation).normalized();
    EXPECT_LT(last.moment.norm(), 1e-9);
    if (n > 0) {
      EXPECT_LT(last.force.norm(), 1e-9);
    }
  }
}

TEST(RigidTire, spin_up_needs_inertia_times_angular_acceleration) {
  Led wheel = led();
  const RigidTire& tire = wheel.tire;
  RimState rim;
  rim.angular_velocity = Vec3(0, 0.01, 0);
  wheel.go(rim, 1e-3);
  EXPECT_NEAR(tire.spindle_wrench().moment.y(), -tire.mass_properties().inertia(1, 1) * 10.0, 1e-12);
  EXPECT_NEAR(tire.spindle_wrench().force.z(), -9.81 * tire.mass_properties().mass, 1e-10);
}

TEST(RigidTire, tire_at_rest_hangs_its_weight_on_the_spindle_along_a_tilted_gravity) {
  const Vec3 gravity(3.0, -1.0, -9.0);
  Led wheel = led({}, gravity);
  const RigidTire& tire = wheel.tire;
  wheel.hold(1, 1e-3);
  EXPECT_EQ(tire.gravity(), gravity);
  EXPECT_LT((tire.spindle_wrench().force - tire.mass_properties().mass * gravity).norm(), 1e-12);
  EXPECT_EQ(tire.spindle_wrench().moment.norm(), 0.0);
}

TEST(RigidTire, contact_forces_reach_the_spindle_with_their_arm) {
  RimState rim;
  rim.position = Vec3(3, 1, 0.5);
  Led wheel = led(rim);
  const RigidTire& tire = wheel.tire;
  const SurfaceState s = wheel.surface();
  const NodalForces f{{5, 40, tire.mesh().vertex_count - 1}, {Vec3(10, 20, 300), Vec3(-5, 0, 100), Vec3(0, -30, 7)}};
  wheel.go(rim, 1e-4, f);
  const Vec3 force = Vec3(0, 0, -9.81 * tire.mass_properties().mass) + test::sum(f);
  const Vec3 moment = test::moment_about(rim.position, f, s);
  EXPECT_LT((tire.spindle_wrench().force - force).norm(), 1e-10);
  EXPECT_LT((tire.spindle_wrench().moment - moment).norm(), 1e-10);
}

/// Work of rim and forces minus the tire's energy and losses, over 200 intervals of an arbitrary rim motion.
double energy_left_over(double h, double& turnover) {
  const auto rim_at = [](double t) {
    RimState rim;
    rim.position = Vec3(2.0 * t + 0.1 * std::sin(9.0 * t), 0.05 * std::cos(7.0 * t), 0.5 - 0.3 * t * t);
    rim.velocity = Vec3(2.0 + 0.9 * std::cos(9.0 * t), -0.35 * std::sin(7.0 * t), -0.6 * t);
    rim.angular_velocity = Vec3(0.3 * std::sin(t), 5.0 + 20.0 * t, 0.2);
    rim.orientation = Quat(Eigen::AngleAxisd(5.0 * t + 10.0 * t * t, Vec3::UnitY()));
    return rim;
  };
  Led wheel = led(rim_at(0.0));
  const RigidTire& tire = wheel.tire;
  const TireDiagnostics start = tire.diagnostics();
  NodalForces f;
  f.vertex = {5, 40, tire.mesh().vertex_count - 1};
  double work = 0.0;
  for (int n = 0; n < 200; ++n) {
    f.force = {Vec3(10, 20, 300), Vec3(-5, n, 100), Vec3(0, -30, 7)};
    const SurfaceState before = wheel.surface();
    wheel.go(rim_at(n * h), h, f);
    work += test::surface_work(f, before, wheel.surface()) + test::rim_work(tire, wheel.path);
  }
  const TireDiagnostics end = tire.diagnostics();
  turnover = std::abs(work) + std::abs(end.kinetic_energy - start.kinetic_energy);
  EXPECT_GT(end.numerical_loss, 0.0);
  return work - (end.stored() - start.stored()) - (end.losses() - start.losses());
}

TEST(RigidTire, energy_closes_to_round_off_whatever_the_rim_does) {
  double turnover = 0.0;
  const double left = energy_left_over(1e-3, turnover);
  EXPECT_GT(turnover, 1.0);
  EXPECT_LT(std::abs(left), 1e-10 * turnover);
}

/// The tire gets an extrapolated rim motion. With a constant acceleration a, the displacement in every interval is a H²
/// longer than the mean velocity times H, and m a · a H² is lost.
TEST(RigidTire, numerical_loss_of_a_constant_acceleration_is_m_a2_h2_in_every_interval) {
  Led wheel = led({}, Vec3::Zero());
  const RigidTire& tire = wheel.tire;
  const double h = 1e-3, a = 7.0;
  RimState rim;
  double before = 0.0;
  for (int n = 0; n < 50; ++n) {
    rim.position.x() = 0.5 * a * n * n * h * h;
    rim.velocity.x() = a * n * h;
    wheel.go(rim, h);
    const double lost = tire.diagnostics().numerical_loss - before;
    before += lost;
    if (n > 1) {
      EXPECT_NEAR(lost / (tire.mass_properties().mass * a * a * h * h), 1.0, 1e-9) << n;
    }
  }
}

TEST(RigidTire, restored_state_is_the_saved_one) {
  RimState rim;
  rim.position = Vec3(1, 2, 3);
  rim.angular_velocity = Vec3(0.1, 5, 0);
  Led wheel = led(rim), again = led();
  const RigidTire &tire = wheel.tire, &other = again.tire;
  wheel.hold(1, 1e-3);
  again.tire.restore(testing::saved(tire));
  EXPECT_EQ(wheel.surface().position, again.surface().position);
  EXPECT_EQ(wheel.surface().velocity, again.surface().velocity);
  EXPECT_EQ(tire.spindle_wrench().moment, other.spindle_wrench().moment);
  EXPECT_EQ(tire.diagnostics().numerical_loss, other.diagnostics().numerical_loss);
}

}  // namespace
}  // namespace furrow::tire
