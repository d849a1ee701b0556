// Properties of every rig: accounts close to the error of the step, a restored rig continues bit for bit, and unusable
// values are refused with their names.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "rigs/half_car_rig.hpp"
#include "rigs/quarter_car_rig.hpp"
#include "rigs/rig_row.hpp"
#include "tests/protocol/fields_of.hpp"
#include "tests/refusal.hpp"
#include "tests/rigs/rig_fixture.hpp"
#include "tests/saved.hpp"

namespace furrow::all_rigs_test {
namespace {

using namespace furrow::testing;
using rigs::Rig;

/// A rig with all its parts: a ramp, a toe step, a camber and a damper.
std::unique_ptr<Rig> drawbar(const std::string& mode, double move_from = 0.0) {
  rigs::DrawbarRigOptions options = reference_options();
  options.mode = mode;
  options.speed = 2.0;
  options.move_from = move_from;
  options.ramp = 0.05;
  options.toe_angle = 0.1;
  options.toe_time = 0.06;
  options.toe_ramp = 0.04;
  options.camber_angle = 0.05;
  options.touchdown_time = 0.08;
  return rigs::make_drawbar_rig(options);
}

std::unique_ptr<Rig> cleat_stand() {
  rigs::DrawbarRigOptions options = reference_options();
  options.mode = "free_rolling";
  options.touchdown_time = 0.02;
  return rigs::make_held_drawbar_rig(options, 0.05);
}

template <class Options>
Options moving_car() {
  Options o;
  o.speed = 3.0, o.ramp = 0.1, o.touchdown_time = 0.08, o.lowering_speed = 0.4;
  o.body_mass = 400.0, o.unsprung_mass = 10.0;
  o.suspension_stiffness = 20e3, o.suspension_damping = 1500.0;
  o.rim_mass = 10.0, o.rim_spin_inertia = 1.0, o.rim_diametral_inertia = 0.5;
  return o;
}

std::unique_ptr<Rig> half_car() {
  auto o = moving_car<rigs::HalfCarOptions>();
  o.body_mass = 700.0, o.pitch_inertia = 900.0, o.front_share = 0.55;
  o.rear_suspension_stiffness = 26e3, o.rear_suspension_damping = 1500.0;
  return rigs::make_half_car(o);
}

std::unique_ptr<Rig> row() {
  std::vector<std::unique_ptr<Rig>> rigs;
  rigs.push_back(drawbar("fixed_speed"));
  rigs.push_back(drawbar("free_rolling"));
  return rigs::make_rig_row(std::move(rigs));
}

struct RigCase {
  const char* name;
  std::function<std::unique_ptr<Rig>()> make;
};

class AllRigs : public ::testing::TestWithParam<RigCase> {
 protected:
  /// With tires, not placed.
  static std::unique_ptr<Rig> made(double tire = 1.0) {
    auto rig = GetParam().make();
    for (int k = 0; k < rig->wheel_count(); ++k) rig->add_tire_mass(k, tire_mass(tire), kRadius);
    return rig;
  }
  static std::unique_ptr<Rig> placed() {
    auto rig = made();
    rig->place(std::vector<double>(rig->wheel_count(), 0.5));
    return rig;
  }
  /// Under wrenches that change with time, from t = `from` on.
  static void ride(Rig& rig, double from, double duration, double step, int substeps = 1) {
    std::vector<Wrench> wrenches(rig.wheel_count());
    for (int i = 0; i < std::lround(duration / step); ++i) {
      const double t = from + (i + 0.5) * step;
      for (int k = 0; k < rig.wheel_count(); ++k)
        wrenches[k] = wrench(Vec3(-800.0 * std::sin(40.0 * t + k), 90.0, 3000.0 + 900.0 * std::sin(70.0 * t + 2 * k)),
                             Vec3(12.0, -150.0, 20.0 * std::cos(30.0 * t)));
      ASSERT_TRUE(rig.advance(wrenches, step, substeps).ok);
    }
  }
};

struct Ride {
  double energy = 0.0, turnover = 0.0;  // residual; turnover, J
  double momentum = 0.0;                // residual, over the tires' impulse
  Ride(const rigs::RigAccounts& start, const rigs::RigAccounts& end) {
    energy = energy_residual(start, end);
    turnover = std::abs(end.tow_work) + std::abs(end.tire_work) + end.damper_loss;
    momentum = momentum_residual(start, end).norm() / end.tire_impulse.norm();
  }
};

TEST_P(AllRigs, accounts_close_momentum_to_round_off_and_energy_to_second_order_of_the_step) {
  const auto ridden = [](double step) {
    const auto rig = placed();
    const rigs::RigAccounts start = rig->accounts();
    EXPECT_EQ(first_missing(start), nullptr);
    ride(*rig, 0.0, 0.2, step);
    EXPECT_GT(rig->accounts().damper_loss, 0.1);
    return Ride(start, rig->accounts());
  };
  const Ride coarse = ridden(4e-4), fine = ridden(2e-4);
  EXPECT_LT(fine.momentum, 1e-8);
  EXPECT_LT(std::abs(fine.energy), 1e-4 * fine.turnover);
  EXPECT_LT(std::abs(fine.energy), 0.35 * std::abs(coarse.energy) + 1e-7 * fine.turnover);
}

TEST_P(AllRigs, continues_bit_for_bit_whether_placed_before_or_not) {
  for (const double time : {0.03, 0.07, 0.11}) {
    const auto original = placed();
    ride(*original, 0.0, time, 1e-4, 2);
    const Archive archive = saved(*original);
    const auto again = placed(), fresh = made();
    again->restore(archive);
    fresh->restore(archive);
    EXPECT_EQ(saved(*fresh).arrays(), saved(*original).arrays());
    for (Rig* rig : {original.get(), again.get(), fresh.get()}) ride(*rig, time, 0.05, 1e-4, 2);
    EXPECT_EQ(saved(*again).arrays(), saved(*original).arrays()) << time;
    EXPECT_EQ(saved(*fresh).arrays(), saved(*original).arrays()) << time;
    EXPECT_EQ(fresh->accounts().damper_loss, original->accounts().damper_loss);
    const std::vector<rigs::Subject> subjects = original->subjects();
    for (int k = 0; k < original->wheel_count(); ++k) {
      EXPECT_EQ(fresh->rim(k).orientation.coeffs(), original->rim(k).orientation.coeffs());
      for (const Column& column : subjects[k].columns)
        EXPECT_EQ(measured(*fresh, k, column.name), measured(*original, k, column.name)) << column.name;
    }
  }
}

TEST_P(AllRigs, a_wrench_that_is_not_finite_is_a_failure_that_names_its_wheel) {
  const auto rig = placed();
  std::vector<Wrench> wrenches(rig->wheel_count());
  wrenches.back().moment.y() = std::numeric_limits<double>::quiet_NaN();
  const Outcome outcome = rig->advance(wrenches, kStep, 1);
  EXPECT_FALSE(outcome.ok);
  EXPECT_EQ(outcome.message("rig"),
            "rig was pulled with a wrench that is not finite: it comes from the tire of wheel " +
                std::to_string(wrenches.size() - 1) + "; try a smaller run.step");
}

TEST_P(AllRigs, refuses_the_state_of_another_tire_and_one_that_lacks_a_number_or_holds_none) {
  const auto rig = placed();
  const Archive archive = saved(*rig);
  EXPECT_THROW(made(2.0)->restore(archive), Error);
  for (const auto& [name, values] : archive.arrays()) {
    if (!name.ends_with("report/drive_torque")) continue;
    Archive lacking = archive;
    lacking.remove(name);
    EXPECT_EQ(refusal(ExitCode::io, [&] { rig->restore(lacking); }), "saved state lacks '" + name + "'");
    Archive broken = archive;
    broken.put(name.substr(0, name.size() - std::string("report/drive_torque").size()) + "placed_height",
               std::numeric_limits<double>::quiet_NaN());
    EXPECT_THROW(rig->restore(broken), Error);
  }
}

#ifndef NDEBUG
TEST_P(AllRigs, that_is_asked_before_it_is_placed_is_a_misuse) {
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_DEATH(static_cast<void>(made()->rim(0)), "check_wheel: precondition failed");
  EXPECT_DEATH(GetParam().make()->place(std::vector<double>{0.5}), "check_tires: precondition failed");
}
#endif

INSTANTIATE_TEST_SUITE_P(
    Rigs, AllRigs,
    ::testing::Values(RigCase{"fixed_angular_speed", [] { return drawbar("fixed_angular_speed"); }},
                      RigCase{"fixed_speed", [] { return drawbar("fixed_speed"); }},
                      RigCase{"free_rolling", [] { return drawbar("free_rolling"); }},
                      RigCase{"moves_later", [] { return drawbar("fixed_speed", 0.05); }},
                      RigCase{"cleat_stand", cleat_stand},
                      RigCase{"quarter_car",
                              [] { return rigs::make_quarter_car(moving_car<rigs::QuarterCarOptions>()); }},
                      RigCase{"half_car", half_car}, RigCase{"row", row}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(Row, accounts_are_the_sums_of_those_of_its_rigs) {
  EXPECT_STREQ(first_missing(rigs::RigAccounts()), "kinetic_energy");
  std::vector<std::unique_ptr<Rig>> two;
  for (int k = 0; k < 2; ++k) two.push_back(rigs::make_drawbar_rig(steady_options()));
  const auto both = rigs::make_rig_row(std::move(two));
  for (int k = 0; k < 2; ++k) both->add_tire_mass(k, tire_mass(), kRadius);
  both->place(std::vector<double>{0.5, 0.5});
  const rigs::RigAccounts sum = both->accounts(), one = placed_rig(steady_options())->accounts();
  EXPECT_EQ(sum.kinetic_energy, 2.0 * one.kinetic_energy);
  EXPECT_EQ(sum.momentum, 2.0 * one.momentum);
}

TEST(Row, the_list_of_fields_of_a_report_forgets_no_member) {
  EXPECT_EQ(names_of<rigs::WheelReport>().size(), member_count<rigs::WheelReport>());
}

}  // namespace
}  // namespace furrow::all_rigs_test
