// The rigid tire against Newton's and Euler's equations.
#include "tire/rigid/rigid_tire.hpp"
#include "tire/ancf/shell_spec.hpp"
#include "tire/read_tire_file.hpp"

#include <gtest/gtest.h>

#include "protocol/core/mean_turn.hpp"

namespace furrow::tire {
namespace {

RigidTire make(const Vec3& gravity = standard_gravity()) {
  TireFile file = read_tire_file(TIRE_DATA "/hmmwv_layered.json");
  file.elements_circumference = 24;
  set_elements_width(file, 6);
  return RigidTire(shell_shape(file), gravity);
}

TEST(RigidTire, free_drop_and_free_spin_ask_nothing_of_the_spindle) {
  RigidTire tire = make();
  RimState rim;
  rim.angular_velocity = Vec3(0, 8.56, 0);
  tire.place(rim);
  RimTrajectory t(rim);
  const double h = 1e-4;
  Wrench last;
  for (int n = 0; n < 100; ++n) {
    t.extend(rim, h);
    EXPECT_TRUE(tire.advance(t, {}, 1).ok);
    last = tire.spindle_wrench();
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
  RigidTire tire = make();
  RimState rim;
  tire.place(rim);
  RimTrajectory t(rim);
  rim.angular_velocity = Vec3(0, 0.01, 0);
  t.extend(rim, 1e-3);
  EXPECT_TRUE(tire.advance(t, {}, 1).ok);
  EXPECT_NEAR(tire.spindle_wrench().moment.y(), -tire.mass_properties().inertia(1, 1) * 10.0, 1e-12);
  EXPECT_NEAR(tire.spindle_wrench().force.z(), -9.81 * tire.mass_properties().mass, 1e-10);
}

TEST(RigidTire, tire_at_rest_hangs_its_weight_on_the_spindle_along_a_tilted_gravity) {
  const Vec3 gravity(3.0, -1.0, -9.0);
  RigidTire tire = make(gravity);
  RimState rim;
  tire.place(rim);
  RimTrajectory t(rim);
  t.extend(rim, 1e-3);
  EXPECT_TRUE(tire.advance(t, {}, 1).ok);
  EXPECT_EQ(tire.gravity(), gravity);
  EXPECT_LT((tire.spindle_wrench().force - tire.mass_properties().mass * gravity).norm(), 1e-12);
  EXPECT_EQ(tire.spindle_wrench().moment.norm(), 0.0);
}

TEST(RigidTire, contact_forces_reach_the_spindle_with_their_arm) {
  RigidTire tire = make();
  RimState rim;
  rim.position = Vec3(3, 1, 0.5);
  tire.place(rim);
  RimTrajectory t(rim);
  SurfaceState s;
  tire.surface(s);
  NodalForces f;
  f.vertex = {5, 40, tire.mesh().vertex_count - 1};
  f.force = {Vec3(10, 20, 300), Vec3(-5, 0, 100), Vec3(0, -30, 7)};
  t.extend(rim, 1e-4);
  EXPECT_TRUE(tire.advance(t, f, 1).ok);
  Vec3 force(0, 0, -9.81 * tire.mass_properties().mass), moment = Vec3::Zero();
  for (int k = 0; k < 3; ++k) {
    force += f.force[k];
    moment += (s.position[f.vertex[k]] - rim.position).cross(f.force[k]);
  }
  EXPECT_LT((tire.spindle_wrench().force - force).norm(), 1e-10);
  EXPECT_LT((tire.spindle_wrench().moment - moment).norm(), 1e-10);
}

/// Work of rim and forces less what the tire holds and lost, over 200 intervals of a rim that is moved at will.
double energy_left_over(RigidTire& tire, double h, double& turnover) {
  const auto rim_at = [](double t) {
    RimState rim;
    rim.position = Vec3(2.0 * t + 0.1 * std::sin(9.0 * t), 0.05 * std::cos(7.0 * t), 0.5 - 0.3 * t * t);
    rim.velocity = Vec3(2.0 + 0.9 * std::cos(9.0 * t), -0.35 * std::sin(7.0 * t), -0.6 * t);
    rim.angular_velocity = Vec3(0.3 * std::sin(t), 5.0 + 20.0 * t, 0.2);
    rim.orientation = Quat(Eigen::AngleAxisd(5.0 * t + 10.0 * t * t, Vec3::UnitY()));
    return rim;
  };
  tire.place(rim_at(0.0));
  RimTrajectory t(rim_at(0.0));
  const TireDiagnostics start = tire.diagnostics();
  NodalForces f;
  f.vertex = {5, 40, tire.mesh().vertex_count - 1};
  SurfaceState before, after;
  double work = 0.0;
  for (int n = 0; n < 200; ++n) {
    f.force = {Vec3(10, 20, 300), Vec3(-5, n, 100), Vec3(0, -30, 7)};
    tire.surface(before);
    t.extend(rim_at(n * h), h);
    EXPECT_TRUE(tire.advance(t, f, 1).ok);
    tire.surface(after);
    for (std::size_t k = 0; k < f.vertex.size(); ++k)
      work += f.force[k].dot(after.position[f.vertex[k]] - before.position[f.vertex[k]]);
    const Wrench w = tire.spindle_wrench();
    work -= w.force.dot(t.end().position - t.start().position) +
            w.moment.dot(mean_turn(t.start().orientation, t.end().orientation));
  }
  const TireDiagnostics end = tire.diagnostics();
  turnover = std::abs(work) + std::abs(end.kinetic_energy - start.kinetic_energy);
  EXPECT_GT(end.numerical_loss, 0.0);
  return work - (end.stored() - start.stored()) - (end.losses() - start.losses());
}

TEST(RigidTire, energy_closes_to_round_off_whatever_the_rim_does) {
  RigidTire tire = make();
  double turnover = 0.0;
  const double left = energy_left_over(tire, 1e-3, turnover);
  EXPECT_GT(turnover, 1.0);
  EXPECT_LT(std::abs(left), 1e-10 * turnover);
}

/// The rim's motion reaches the tire extrapolated: with a constant acceleration a every interval's way is a H² longer
/// than the mean of its velocities says, and m a · a H² is lost.
TEST(RigidTire, numerical_loss_of_a_constant_acceleration_is_m_a2_h2_in_every_interval) {
  RigidTire tire = make(Vec3::Zero());
  const double h = 1e-3, a = 7.0;
  RimState rim;
  tire.place(rim);
  RimTrajectory t(rim);
  double before = 0.0;
  for (int n = 0; n < 50; ++n) {
    rim.position.x() = 0.5 * a * n * n * h * h;
    rim.velocity.x() = a * n * h;
    t.extend(rim, h);
    EXPECT_TRUE(tire.advance(t, {}, 1).ok);
    const double lost = tire.diagnostics().numerical_loss - before;
    before += lost;
    if (n > 1) {
      EXPECT_NEAR(lost / (tire.mass_properties().mass * a * a * h * h), 1.0, 1e-9) << n;
    }
  }
}

TEST(RigidTire, restored_state_is_the_saved_one) {
  RigidTire tire = make(), other = make();
  RimState rim;
  rim.position = Vec3(1, 2, 3);
  rim.angular_velocity = Vec3(0.1, 5, 0);
  tire.place(rim);
  RimTrajectory t(rim);
  t.extend(rim, 1e-3);
  EXPECT_TRUE(tire.advance(t, {}, 1).ok);
  Archive a;
  tire.save(a);
  other.restore(a);
  SurfaceState s, r;
  tire.surface(s);
  other.surface(r);
  for (std::size_t k = 0; k < s.position.size(); ++k) {
    EXPECT_EQ(s.position[k], r.position[k]);
    EXPECT_EQ(s.velocity[k], r.velocity[k]);
  }
  EXPECT_EQ(tire.spindle_wrench().moment, other.spindle_wrench().moment);
  EXPECT_EQ(tire.diagnostics().numerical_loss, other.diagnostics().numerical_loss);
}

}  // namespace
}  // namespace furrow::tire
