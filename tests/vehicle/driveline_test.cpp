// Engine, converter and gearbox: closed forms, separate energy accounts, shifts, saved states.
#include <gtest/gtest.h>

#include <numbers>

#include "protocol/core/error.hpp"
#include "tests/protocol/fields_of.hpp"
#include "tests/saved.hpp"
#include "tests/vehicle/rate_controls.hpp"
#include "tests/verification/record.hpp"
#include "vehicle/driveline/engine.hpp"
#include "vehicle/driveline/friction_coupling.hpp"
#include "vehicle/driveline/gearbox.hpp"
#include "vehicle/driveline/gears.hpp"
#include "vehicle/driveline/shift_logic.hpp"
#include "vehicle/driveline/torque_converter.hpp"

using namespace furrow;
using furrow::testing::held, furrow::testing::member_count, furrow::testing::names_of, furrow::testing::saved,
    furrow::testing::torque;
using vehicle::Gearbox, vehicle::kGround, vehicle::Table;

namespace {

constexpr double kRpm = std::numbers::pi / 30.0;  // rad/s

Table rpm_table(const std::string& name, std::vector<std::pair<double, double>> points) {
  for (auto& point : points) point.first *= kRpm;
  return Table(name, std::move(points), vehicle::TableCurve::linear, vehicle::TableEnd::constant);
}

// Engine and converter of a HMMWV.
vehicle::EngineOptions engine_options() {
  return {rpm_table("full", {{-100, 300}, {800, 382},  {900, 490},  {1000, 579}, {1100, 650}, {1200, 706}, {1300, 746},
                             {1400, 774}, {1500, 789}, {1600, 793}, {1700, 788}, {1800, 774}, {1900, 754}, {2000, 728},
                             {2100, 697}, {2200, 664}, {2300, 628}, {2400, 593}, {2500, 558}, {2700, -400}}),
          rpm_table("losses", {{-50, 30}, {0, 0}, {50, -30}, {1000, -50}, {2000, -70}, {3000, -90}}), 0.0, 10.0};
}

vehicle::ConverterOptions converter_options() {
  return {Table("K", {{0, 15}, {0.25, 15}, {0.5, 15}, {0.75, 16}, {0.9, 18}, {1, 35}}),
          Table("T", {{0, 2}, {0.25, 1.8}, {0.5, 1.5}, {0.75, 1.15}, {1, 1}})};
}

}  // namespace

TEST(Engine, settles_where_torque_losses_and_load_balance) {
  vehicle::System system;
  const int crank = system.add_shaft("crank", 1.1, kGround, Vec3::UnitX(), 1500 * kRpm);
  vehicle::Engine engine(system, "engine", crank, engine_options());
  system.add_rate_row({"load", {{crank, 1.0}}, {}}, torque(-559.0));
  engine.set_throttle(1.0);
  system.assemble(0.0);
  for (int i = 0; i < 10000; ++i) ASSERT_TRUE(system.step(1e-3).ok);
  // Between 2200 (664 − 74) and 2300 (628 − 76): 590 − 0.38 (n − 2200) = 559.
  EXPECT_NEAR(system.shaft(crank).state.speed / kRpm, 2200.0 + 31.0 / 0.38, 0.01);
}

TEST(Engine, governor_keeps_the_engine_idling_at_closed_throttle) {
  vehicle::EngineOptions options = engine_options();
  options.idle_speed = 800 * kRpm;
  vehicle::System system;
  const int crank = system.add_shaft("crank", 1.1, kGround, Vec3::UnitX(), 1500 * kRpm);
  vehicle::Engine engine(system, "engine", crank, options);
  system.assemble(0.0);
  for (int i = 0; i < 30000; ++i) ASSERT_TRUE(system.step(1e-3).ok);
  EXPECT_GT(system.shaft(crank).state.speed, 780 * kRpm);
  EXPECT_LT(system.shaft(crank).state.speed, 800 * kRpm);
  engine.set_throttle(0.3);
  const Archive archive = saved(engine);
  engine.set_throttle(0.0);
  engine.restore(archive);
  EXPECT_EQ(engine.throttle(), 0.3);
}

TEST(Converter, stall_balances_the_engine_against_the_square_law) {
  // Turbine held: T_engine(ω) = (ω/15)², turbine torque twice that.
  vehicle::System system;
  const int crank = system.add_shaft("crank", 1.1, kGround, Vec3::UnitX(), 800 * kRpm);
  const int turbine = system.add_shaft("turbine", 0.3, kGround, Vec3::UnitX());
  vehicle::EngineOptions options = engine_options();
  vehicle::Engine engine(system, "engine", crank, options);
  vehicle::TorqueConverter converter(system, "converter", crank, turbine, converter_options());
  const int stall = system.add_rate_row({"stall", {{turbine, 1.0}}, {}}, held(0.0));
  engine.set_throttle(1.0);
  system.assemble(0.0);
  for (int i = 0; i < 20000; ++i) ASSERT_TRUE(system.step(1e-3).ok);
  const double speed = system.shaft(crank).state.speed;
  verification::verify("converter stalled", "torque of the engine, N m",
                       options.full.value(speed) + options.losses.value(speed), std::pow(speed / 15.0, 2), 1e-8,
                       "square law of the converter");
  verification::verify("converter stalled", "torque that holds the turbine, N m", -system.rate_state(stall).torque,
                       2.0 * std::pow(speed / 15.0, 2), 1e-8, "twice that of the engine");
  EXPECT_NEAR(speed / kRpm, 2500.0, 200.0);
}

TEST(Converter, torques_are_continuous_through_speed_ratio_one_and_everywhere_else) {
  const vehicle::ConverterOptions o = converter_options();
  for (const double impeller : {-20.0, 0.0, 1e-6, 50.0, 200.0}) {
    vehicle::ConverterTorque before = vehicle::converter_torque(o, impeller, -100.0);
    for (double turbine = -100.0; turbine < 400.0; turbine += 0.01) {
      const vehicle::ConverterTorque now = vehicle::converter_torque(o, impeller, turbine);
      ASSERT_LT(std::abs(now.impeller - before.impeller), 0.7) << impeller << " " << turbine;
      ASSERT_LT(std::abs(now.turbine - before.turbine), 0.7) << impeller << " " << turbine;
      // The converter never generates power.
      ASSERT_GE(now.impeller * impeller - now.turbine * turbine, -1e-9) << impeller << " " << turbine;
      before = now;
    }
  }
  // Outside the blend the tables apply.
  EXPECT_NEAR(vehicle::converter_torque(o, 150.0, 75.0).turbine, 1.5 * 100.0, 1e-10);
  EXPECT_NEAR(vehicle::converter_torque(o, 75.0, 150.0).impeller, -100.0, 1e-10);
  EXPECT_EQ(vehicle::converter_torque(o, 100.0, 100.0).impeller, 0.0);
}

TEST(Converter, heat_is_what_the_shafts_lose_and_the_motion_is_of_second_order) {
  const auto run = [](int steps, double* heat, double* lost) {
    vehicle::System system;
    const int in = system.add_shaft("in", 1.1, kGround, Vec3::UnitX(), 250.0);
    const int out = system.add_shaft("out", 0.9, kGround, Vec3::UnitX(), 70.0);
    vehicle::TorqueConverter converter(system, "converter", in, out, converter_options());
    system.assemble(0.0);
    const double start = system.kinetic_energy();
    for (int i = 0; i < steps; ++i) EXPECT_TRUE(system.step(0.07 / steps).ok);
    if (heat) *heat = converter.heat(system), *lost = start - system.kinetic_energy();
    return system.shaft(out).state.speed;
  };
  double heat = 0.0, lost = 0.0;
  const double reference = run(12800, &heat, &lost);
  EXPECT_NEAR(heat, lost, 1e-9 * lost);
  // Between speed ratios 0.25 and 0.5 the tables have no kink.
  EXPECT_NEAR((run(100, nullptr, nullptr) - reference) / (run(200, nullptr, nullptr) - reference), 4.0, 0.2);
}

namespace {

// Engine side and vehicle side with a gearbox between them.
struct Train {
  static constexpr double J1 = 1.5, J2 = 40.0;
  vehicle::System system;
  int in, out, drive, road;
  Gearbox gearbox;
  explicit Train(double shift_time, double torque_in = 0.0, double torque_out = 0.0)
      : in(system.add_shaft("in", J1, kGround, Vec3::UnitX(), 250.0)),
        out(system.add_shaft("out", J2, kGround, Vec3::UnitX(), 50.0)),
        drive(system.add_rate_row({"drive", {{in, 1.0}}, {}}, torque(torque_in))),
        road(system.add_rate_row({"road", {{out, 1.0}}, {}}, torque(torque_out))),
        gearbox(system, "gearbox", in, out, {0.2, 0.4, 0.8}, shift_time, 0) {
    system.assemble(0.0);
  }
  void run(int steps, double h = 1e-3) {
    for (int i = 0; i < steps; ++i) {
      ASSERT_TRUE(gearbox.advance(system, h).ok);
      ASSERT_TRUE(system.step(h).ok);
    }
  }
  double speed(int shaft) const { return system.shaft(shaft).state.speed; }
};

}  // namespace

TEST(Gearbox, shift_without_time_is_the_inelastic_impact_and_its_energy_is_on_its_account) {
  for (const double h : {1e-3, 4e-5}) {
    Train train(0.0);
    train.run(10, h);
    ASSERT_TRUE(train.gearbox.shift(train.system, 1).ok);
    train.run(1, h);
    // Impulse P on the output, −0.4 P on the input, until u_out = 0.4 u_in.
    const double P = (0.4 * 250.0 - 50.0) / (1.0 / Train::J2 + 0.16 / Train::J1);
    EXPECT_NEAR(train.speed(train.out), 50.0 + P / Train::J2, 1e-9);
    EXPECT_NEAR(train.speed(train.in), 250.0 - 0.4 * P / Train::J1, 1e-9);
    EXPECT_NEAR(train.gearbox.loss(train.system), 0.5 * P * 50.0, 1e-7);  // half the impulse times the slip
    EXPECT_EQ(train.system.redundant_count(), 0);
    EXPECT_FALSE(train.gearbox.shifting());
  }
}

TEST(Gearbox, shift_under_power_hands_the_torque_over_and_ends_in_time) {
  Train train(0.4, 300.0, -1200.0);
  const double start = train.system.kinetic_energy();
  train.run(100);
  const double before = train.gearbox.output_torque(train.system);
  ASSERT_TRUE(train.gearbox.shift(train.system, 1).ok);
  double torque_before = before, largest_jump = 0.0;
  int held = 0;  // steps in which the old gear still holds
  for (int i = 0; i < 401; ++i) {
    train.run(1);
    if (std::abs(train.speed(train.out) - 0.2 * train.speed(train.in)) < 1e-10) ++held;
    largest_jump = std::max(largest_jump, std::abs(train.gearbox.output_torque(train.system) - torque_before));
    torque_before = train.gearbox.output_torque(train.system);
    EXPECT_TRUE(i != 398 || train.gearbox.shifting());
  }
  EXPECT_GT(held, 50);
  EXPECT_LT(held, 201);
  EXPECT_LT(largest_jump, 0.1 * std::abs(before));
  EXPECT_FALSE(train.gearbox.shifting());
  EXPECT_EQ(train.gearbox.gear(), 1);
  EXPECT_NEAR(train.speed(train.out), 0.4 * train.speed(train.in), 1e-10);
  EXPECT_GT(train.gearbox.loss(train.system), 0.0);
  const double work = train.system.rate_state(train.drive).work + train.system.rate_state(train.road).work;
  EXPECT_NEAR(train.system.kinetic_energy(), start + work - train.gearbox.loss(train.system), 1e-8 * start);
  EXPECT_EQ(train.system.redundant_count(), 0);
}

TEST(Gearbox, down_shift_under_power_lets_the_engine_rise_and_takes_no_energy_from_nowhere) {
  Train train(0.4, 300.0, -600.0);
  ASSERT_TRUE(train.gearbox.shift(train.system, 1).ok);
  train.run(1000);
  double loss = train.gearbox.loss(train.system);
  ASSERT_TRUE(train.gearbox.shift(train.system, 0).ok);
  for (int i = 0; i < 450; ++i) {
    train.run(1);
    ASSERT_GE(train.gearbox.loss(train.system), loss - 1e-9);
    loss = train.gearbox.loss(train.system);
  }
  EXPECT_FALSE(train.gearbox.shifting());
  EXPECT_NEAR(train.speed(train.out), 0.2 * train.speed(train.in), 1e-10);
}

TEST(Gearbox, neutral_lets_both_sides_run_free) {
  Train train(0.2, 30.0, 0.0);
  ASSERT_TRUE(train.gearbox.shift(train.system, vehicle::kNeutral).ok);
  train.run(1000);
  EXPECT_NEAR(train.speed(train.in), 250.0 + 20.0, 1e-10);
  EXPECT_NEAR(train.speed(train.out), 50.0, 1e-12);
  ASSERT_TRUE(train.gearbox.shift(train.system, 2).ok);
  train.run(201);
  EXPECT_NEAR(train.speed(train.out), 0.8 * train.speed(train.in), 1e-10);
}

TEST(Gearbox, resumed_in_the_middle_of_each_phase_continues_bit_for_bit) {
  for (const int steps : {100, 300}) {
    Train original(0.4, 300.0, -1200.0), copy(0.4, 300.0, -1200.0);
    original.run(20);
    ASSERT_TRUE(original.gearbox.shift(original.system, 1).ok);
    original.run(steps);
    ASSERT_TRUE(original.gearbox.shifting());
    const Archive archive = saved(original.system, original.gearbox);
    copy.system.restore(archive);
    copy.gearbox.restore(archive);
    original.run(400);
    copy.run(400);
    EXPECT_EQ(saved(copy.system, copy.gearbox).arrays(), saved(original.system, original.gearbox).arrays());
    EXPECT_FALSE(copy.gearbox.shifting());
  }
  EXPECT_EQ(names_of<vehicle::GearboxState>().size(), member_count<vehicle::GearboxState>());
}

TEST(Gearbox, a_gear_that_closes_a_loop_is_a_failure) {
  vehicle::System system;
  const int a = system.add_shaft("a", 1.0, kGround, Vec3::UnitX()),
            b = system.add_shaft("b", 1.0, kGround, Vec3::UnitX());
  vehicle::add_gear(system, "bypass", a, b, 0.4);
  Gearbox box(system, "box", a, b, {0.2, 0.4}, 0.0);
  system.assemble(0.0);
  EXPECT_FALSE(box.shift(system, 1).ok);
  EXPECT_THROW(Gearbox(system, "zero", a, b, {0.2, 0.0}, 0.1), Error);
  EXPECT_THROW(Gearbox(system, "late", a, b, {0.2}, -0.1), Error);
}

TEST(ShiftLogic, shifts_at_its_speeds_and_waits_for_its_latency) {
  vehicle::ShiftLogic logic;
  logic.options = {2500 * kRpm, 1200 * kRpm, 1.0};
  EXPECT_EQ(logic.wanted(0, 3, 2400 * kRpm, 5.0), 0);
  EXPECT_EQ(logic.wanted(0, 3, 2501 * kRpm, 5.1), 1);
  EXPECT_EQ(logic.wanted(1, 3, 1100 * kRpm, 5.5), 1);  // too early
  EXPECT_EQ(logic.wanted(1, 3, 1250 * kRpm, 6.2), 1);  // between both speeds
  EXPECT_EQ(logic.wanted(1, 3, 1100 * kRpm, 6.3), 0);
  EXPECT_EQ(logic.wanted(2, 3, 2600 * kRpm, 9.0), 2);  // no higher gear
}

// Engine, converter, gearbox, differential with a lock, brakes: with a separate account for every energy.
TEST(Driveline, energies_of_engine_converter_shifts_and_brakes_add_up) {
  vehicle::System system;
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY();
  const int crank = system.add_shaft("crank", 1.1, kGround, x, 800 * kRpm);
  const int turbine = system.add_shaft("turbine", 0.3, kGround, x);
  const int propeller = system.add_shaft("propeller", 0.5, kGround, x), box = system.add_shaft("box", 0.6, kGround, y);
  const int left = system.add_shaft("left", 30.0, kGround, y), right = system.add_shaft("right", 32.0, kGround, y);
  const int frame = system.add_shaft("frame", 1.0, kGround, y);
  vehicle::Engine engine(system, "engine", crank, engine_options());
  vehicle::TorqueConverter converter(system, "converter", crank, turbine, converter_options());
  Gearbox gearbox(system, "gearbox", turbine, propeller, {0.2, 0.4, 0.8}, 0.3, 0);
  vehicle::add_gear(system, "conical gear", propeller, box, 0.2);
  vehicle::add_differential(system, "differential", box, left, right);
  system.add_rate_row({"frame held", {{frame, 1.0}}, {}}, held(0.0));
  const auto lock = vehicle::FrictionCoupling::clutch(system, "lock", left, right, 100.0);
  const auto brake = vehicle::FrictionCoupling::clutch(system, "brake", left, frame, 4000.0);
  vehicle::ShiftLogic logic;
  logic.options = {2500 * kRpm, 1200 * kRpm, 1.0};
  logic.last_shift = 0.0;
  system.assemble(0.0);
  engine.set_throttle(1.0);
  const double start = system.kinetic_energy();
  int shifts = 0;
  for (int i = 0; i < 12000; ++i) {
    if (i == 7000) engine.set_throttle(0.0), brake.engage(system, 0.02);
    if (i == 8000) lock.engage(system, 1.0);
    if (!gearbox.shifting() && i < 7000) {
      const int wanted = logic.wanted(gearbox.gear(), 3, system.shaft(turbine).state.speed, system.time());
      if (wanted != gearbox.gear()) {
        ASSERT_TRUE(gearbox.shift(system, wanted).ok);
        ++shifts;
      }
    }
    ASSERT_TRUE(gearbox.advance(system, 1e-3).ok);
    ASSERT_TRUE(system.step(1e-3).ok);
  }
  EXPECT_GE(shifts, 1);
  EXPECT_GT(brake.heat(system), 0.0);
  const double spent = converter.heat(system) + gearbox.loss(system) + brake.heat(system) + lock.heat(system);
  EXPECT_NEAR(start + engine.work(system) - spent, system.kinetic_energy(), 1e-8 * std::abs(engine.work(system)));
}
