// The flexible ring with the interface of tires: momentum, energy, exact continuation, failures.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/refusal.hpp"
#include "tests/saved.hpp"
#include "tests/tire/extruded_ride.hpp"
#include "tire/tires.hpp"

namespace furrow::tire::ring_tire_test {
namespace {

constexpr double kStep = 1e-4;  // s

TireOptions options(int segments = 60) {
  TireOptions o;
  o.file = TIRE_DATA "/hmmwv_ring.json";
  o.elements_circumference = segments;
  return o;
}

TEST(RingTire, momentum_changes_by_ground_gravity_and_spindle_to_round_off) {
  EXPECT_LT(Ride(options(), kStep).worst_force, 1e-11);
  EXPECT_LT(Ride(options(), kStep, 0.1).worst_force, 1e-11);  // with a slip angle
}

TEST(RingTire, the_account_of_energy_closes_but_for_second_order) {
  const Ride ride(options(), kStep), finer(options(), 0.5 * kStep);
  EXPECT_GT(ride.last.dissipation, 0.1);
  EXPECT_LT(std::abs(ride.residual), 1e-5 * ride.work) << ride.work;
  EXPECT_LT(std::abs(ride.residual), 1e-3 * ride.last.dissipation) << ride.last.dissipation;
  EXPECT_LT(std::abs(finer.residual), 0.35 * std::abs(ride.residual));
  EXPECT_NEAR(finer.last.dissipation, ride.last.dissipation, 0.05 * ride.last.dissipation);
  EXPECT_LT(std::abs(ride.last.numerical_loss), 0.1 * ride.last.dissipation);
  EXPECT_LT(std::abs(ride.last.solver_loss), 1e-6 * ride.last.dissipation);
  const Ride turned(options(), kStep, 0.1);
  EXPECT_NEAR(turned.residual / turned.work, 0.0, 2e-3);
}

TEST(RingTire, its_moment_is_that_of_the_forces_on_a_rim_at_rest) {
  const auto tire = make_tire(options());
  RimState rim;
  rim.position = Vec3(0.3, 0.1, 0.5);
  rim.orientation = Quat(Eigen::AngleAxisd(0.4, Vec3::UnitZ())) * Quat(Eigen::AngleAxisd(0.1, Vec3::UnitX()));
  RimTrajectory motion(rim);
  tire->place(rim);
  SurfaceState surface;
  for (int k = 0; k < 2000; ++k) {
    motion.extend(rim, kStep);
    tire->surface(surface);
    ASSERT_TRUE(tire->advance(motion, loads(surface, rim, 0.0), 1).ok);
  }
  const NodalForces f = loads(surface, rim, 0.0);
  const Vec3 force = tire->mass_properties().mass * tire->gravity() + test::sum(f);
  const Vec3 moment = test::moment_about(rim.position, f, surface);
  // The belt sags under its own weight: the remaining moment is that of its first moment of mass.
  EXPECT_LT((tire->spindle_wrench().force - force).norm(), 1e-4 * force.norm());
  EXPECT_LT((tire->spindle_wrench().moment - moment).norm(), 1e-3 * moment.norm());
}

TEST(RingTire, a_restored_tire_continues_bit_for_bit) {
  expect_exact_continuation(options(), kStep);
  // Also with a pressure other than its file's.
  const auto one = make_tire(options()), other = make_tire(options());
  RimTrajectory rim(rim_at(0.0));
  one->place(rim.end());
  one->set_pressure(1.3e5);
  const auto go = [&](Tire& tire, RimTrajectory& motion) {
    SurfaceState surface;
    for (int k = 0; k < 50; ++k) {
      motion.extend(rim_at(k * kStep), kStep);
      tire.surface(surface);
      const Outcome outcome = tire.advance(motion, loads(surface, motion.start(), k * kStep), 1);
      ASSERT_TRUE(outcome.ok) << outcome.message("tire") << " in step " << k;
    }
  };
  go(*one, rim);
  other->restore(testing::saved(*one));
  RimTrajectory copy = rim;
  go(*one, rim), go(*other, copy);
  Hash a, b;
  one->add_state(a), other->add_state(b);
  EXPECT_EQ(a.value(), b.value());
  EXPECT_EQ(one->diagnostics().stored(), other->diagnostics().stored());
}

TEST(RingTire, its_surface_is_the_shape_that_it_was_described_with) {
  for (const int segments : {24, 37})
    for (const bool rigid : {false, true}) expect_described_shape(options(segments), rigid);
}

TEST(RingTire, what_cannot_go_on_says_so) {
  expect_limits_are_told(options(), kStep, {{60, 61}, std::vector<Vec3>(2, Vec3(0.0, 0.0, 1e5))},
                         "pressed further than a flexible ring is meant for");
}

}  // namespace
}  // namespace furrow::tire::ring_tire_test
