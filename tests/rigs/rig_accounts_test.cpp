// The rig's accounts of energy and momentum: closed forms, and that they close to the error of the step.
#include <gtest/gtest.h>

#include <cmath>

#include "protocol/core/constants.hpp"
#include "rigs/rig_row.hpp"
#include "tests/rigs/rig_fixture.hpp"

using namespace furrow;
using namespace furrow::testing;

namespace {

double energy_residual(const rigs::RigAccounts& start, const rigs::RigAccounts& end) {
  return end.drive_work + end.tow_work + end.guide_work + end.tire_work - (end.stored() - start.stored()) -
         end.damper_loss;
}

Vec3 momentum_residual(const rigs::RigAccounts& start, const rigs::RigAccounts& end) {
  return end.momentum - start.momentum - end.gravity_impulse - end.guide_impulse - end.tire_impulse;
}

/// A ramp, a toe step, a damper and a wrench that changes: everything that the rig has, at once.
struct Ride {
  rigs::RigAccounts start, end;
  explicit Ride(double step, const std::string& mode = "fixed_angular_speed") {
    rigs::DrawbarRigOptions options = reference_options();
    options.mode = mode;
    options.speed = 2.0;
    options.ramp = 0.05;
    options.toe_angle = 0.1;
    options.toe_time = 0.06;
    options.toe_ramp = 0.04;
    options.camber_angle = 0.05;
    options.touchdown_time = 0.08;
    const auto rig = placed_rig(options);
    start = rig->accounts();
    const int steps = static_cast<int>(std::lround(0.2 / step));
    for (int i = 0; i < steps; ++i) {
      const double t = (i + 0.5) * step;
      advance(*rig,
              wrench(Vec3(-800.0 * std::sin(40.0 * t), 90.0, 2000.0 + 900.0 * std::sin(70.0 * t)),
                     Vec3(12.0, -150.0, 20.0 * std::cos(30.0 * t))),
              1, step);
    }
    end = rig->accounts();
  }
};

}  // namespace

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
  // At rest in z, guide and tire carry the weight together; what the guide gave while the axle fell is before that.
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

TEST(RigAccounts, momentum_closes_to_round_off) {
  const Ride ride(1e-4);
  EXPECT_GT(ride.end.tire_impulse.norm(), 300.0);
  EXPECT_GT(ride.end.guide_impulse.norm(), 50.0);
  EXPECT_LT(momentum_residual(ride.start, ride.end).norm(), 1e-9 * ride.end.tire_impulse.norm());
}

TEST(RigAccounts, energy_closes_to_second_order_of_the_step) {
  for (const char* mode : {"fixed_angular_speed", "free_rolling"}) {
    const Ride coarse(4e-4, mode), fine(2e-4, mode);
    const double scale = std::abs(fine.end.tire_work) + std::abs(fine.end.tow_work) + fine.end.damper_loss;
    const double a = energy_residual(coarse.start, coarse.end), b = energy_residual(fine.start, fine.end);
    EXPECT_GT(fine.end.damper_loss, 10.0);
    EXPECT_LT(std::abs(b), 1e-4 * scale) << mode;
    EXPECT_LT(std::abs(b), 0.35 * std::abs(a) + 1e-9 * scale) << mode << ": " << a << " and " << b << " J";
  }
}

TEST(RigAccounts, every_member_is_said_by_rigs_and_by_rows_of_them) {
  EXPECT_STREQ(first_missing(rigs::RigAccounts()), "kinetic_energy");
  std::vector<std::unique_ptr<rigs::Rig>> two;
  for (int k = 0; k < 2; ++k) two.push_back(rigs::make_drawbar_rig(steady_options()));
  const auto row = rigs::make_rig_row(std::move(two));
  for (int k = 0; k < 2; ++k) row->add_tire_mass(k, tire_mass(), kRadius);
  row->place(std::vector<double>{0.5, 0.5});
  const rigs::RigAccounts both = row->accounts(), one = placed_rig(steady_options())->accounts();
  EXPECT_EQ(first_missing(both), nullptr);
  EXPECT_NEAR(both.kinetic_energy, 2.0 * one.kinetic_energy, 1e-12 * both.kinetic_energy);
  EXPECT_LT((both.momentum - 2.0 * one.momentum).norm(), 1e-12 * both.momentum.norm());
}
