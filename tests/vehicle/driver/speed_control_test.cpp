// The PI law for the speed against the exact solution, and at its bounds.
#include "vehicle/driver/speed_control.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/vehicle/driver/bicycle.hpp"

using namespace furrow;
using namespace furrow::testing;
using namespace furrow::vehicle;

namespace {

/// A mass on a level road, driven by a law, against a resistance.
struct Mass {
  SpeedControl control;
  SpeedState state;
  DriverInputs inputs;
  double speed = 0.0;
  int steps = 0;

  template <class Resistance>
  void step(double dt, const Resistance& resistance) {
    const DriverCar car = test_car();
    control.press(steps++ * dt, speed, state, inputs);
    const double force = inputs.throttle * car.drive_force - inputs.brake * car.brake_force - resistance(speed);
    speed += dt * force / car.mass;
  }
};

double none(double) { return 0.0; }

SpeedSpec hold(double target) {
  SpeedSpec spec;
  spec.target = {{0.0, target}};
  return spec;
}

/// The largest deviation from the exact answer to a step of 1 m/s, in 12 s.
double step_error(double frequency, double damping, bool own_gains, double dt) {
  const double m_over_f = test_car().mass / test_car().drive_force;
  SpeedSpec spec = hold(11.0);
  spec.hysteresis = 0.0;
  if (own_gains) {
    spec.proportional = 2.0 * damping * frequency * m_over_f;
    spec.integral = frequency * frequency * m_over_f;
  }
  Mass mass{SpeedControl(spec, test_car()), {}, {}, 10.0};
  double worst = 0.0;
  for (int i = 0; i * dt < 12.0; ++i) {
    const double t = i * dt, decay = std::exp(-damping * frequency * t);
    // ë + 2ζω ė + ω² e = 0, e(0) = 1, ė(0) = −2ζω
    double exact = (1.0 - frequency * t) * decay;
    if (damping < 1.0) {
      const double root = std::sqrt(1.0 - damping * damping), phase = root * frequency * t;
      exact = decay * (std::cos(phase) - damping / root * std::sin(phase));
    }
    worst = std::max(worst, std::abs(11.0 - mass.speed - exact));
    mass.step(dt, none);
  }
  return worst;
}

}  // namespace

TEST(SpeedControl, step_response_is_the_exact_one_of_second_order) {
  const double critical = step_error(0.5, 1.0, false, 1e-3);  // gains from the vehicle
  EXPECT_LT(critical, 1e-3);
  EXPECT_NEAR(step_error(0.5, 1.0, false, 5e-4) / critical, 0.5, 0.02);  // the mass moves by Euler's steps
  EXPECT_LT(step_error(0.8, 0.4, true, 1e-3), 1e-3);
}

TEST(SpeedControl, gains_come_from_mass_and_drive_force) {
  const SpeedControl control(hold(5.0), test_car());
  EXPECT_DOUBLE_EQ(control.proportional(), 0.24);
  EXPECT_DOUBLE_EQ(control.integral(), 0.06);
}

TEST(SpeedControl, integral_waits_while_the_throttle_is_at_its_stop) {
  SpeedSpec spec;
  spec.target = {{0.0, 12.0}, {60.0, 12.0}, {60.001, 9.0}};
  Mass mass{SpeedControl(spec, test_car()), {}, {}, 0.0};
  const auto resistance = [](double v) { return 1e4 * v * v / 100.0; };  // top speed 10 m/s
  const double dt = 1e-2;
  for (int i = 0; i < 6000; ++i) mass.step(dt, resistance);
  EXPECT_NEAR(mass.speed, 10.0, 0.05);
  EXPECT_GT(mass.inputs.throttle, 0.97);
  EXPECT_LE(mass.state.integral + mass.control.proportional() * mass.state.error, 1.0 + 1e-2);
  mass.step(dt, resistance);
  mass.step(dt, resistance);
  EXPECT_LT(mass.inputs.throttle, 0.4);  // 0.24 s/m · 3 m/s below 1, at once
  double lowest = mass.speed;
  for (int i = 0; i < 2000; ++i) {
    mass.step(dt, resistance);
    lowest = std::min(lowest, mass.speed);
  }
  EXPECT_NEAR(mass.speed, 9.0, 0.05);
  EXPECT_GT(lowest, 8.0);
}

TEST(SpeedControl, integral_waits_while_the_brake_is_at_its_stop) {
  Mass mass{SpeedControl(hold(5.0), test_car()), {}, {}, 40.0};
  const auto push = [](double) { return -30e3; };  // downhill, stronger than the brakes
  for (int i = 0; i < 1000; ++i) mass.step(1e-2, push);
  EXPECT_EQ(mass.inputs.brake, 1.0);
  EXPECT_EQ(mass.state.integral, 0.0);  // the demand began beyond the bound
}

TEST(SpeedControl, changes_the_pedal_only_beyond_the_hysteresis) {
  SpeedSpec spec = hold(10.0);
  spec.proportional = 1.0;
  spec.integral = 0.0;
  spec.hysteresis = 0.1;
  const SpeedControl control(spec, test_car());
  SpeedState state;
  DriverInputs inputs;
  int time = 0;
  const auto demand = [&](double u) { control.press(++time, 10.0 - u, state, inputs); };
  demand(0.5);
  EXPECT_NEAR(inputs.throttle, 0.5, 1e-12);
  demand(-0.09);
  EXPECT_EQ(inputs.throttle, 0.0);
  EXPECT_EQ(inputs.brake, 0.0);
  EXPECT_FALSE(state.braking);
  demand(-0.2);
  EXPECT_EQ(inputs.throttle, 0.0);
  EXPECT_NEAR(inputs.brake, 0.1, 1e-12);  // the brake is twice as strong as the engine
  demand(0.09);
  EXPECT_EQ(inputs.throttle, 0.0);
  EXPECT_EQ(inputs.brake, 0.0);
  EXPECT_TRUE(state.braking);
  demand(0.2);
  EXPECT_NEAR(inputs.throttle, 0.2, 1e-12);
  EXPECT_EQ(inputs.brake, 0.0);
  demand(-5.0);
  EXPECT_EQ(inputs.brake, 1.0);
  demand(5.0);
  EXPECT_EQ(inputs.throttle, 1.0);
}

TEST(SpeedControl, stops_and_holds_until_the_target_rises) {
  SpeedSpec spec;
  spec.target = {{0.0, 0.0}, {1.0, 0.0}, {2.0, 5.0}, {10.0, 5.0}, {12.0, 0.0}};
  Mass mass{SpeedControl(spec, test_car()), {}, {}, 0.0};
  const auto slope = [&](double v) { return std::abs(v) > 1e-9 || mass.inputs.brake < 0.5 ? 3e3 : 0.0; };
  for (int i = 0; i < 1000; ++i) {
    mass.step(1e-3, none);
    ASSERT_TRUE(mass.state.stopped && mass.inputs.brake == 1.0 && mass.inputs.throttle == 0.0);
    mass.speed = 0.0;  // held
  }
  for (int i = 0; i < 9000; ++i) mass.step(1e-3, slope);
  EXPECT_FALSE(mass.state.stopped);
  EXPECT_NEAR(mass.speed, 5.0, 0.3);
  for (int i = 0; i < 20000 && !mass.state.stopped; ++i) mass.step(1e-3, slope);
  EXPECT_TRUE(mass.state.stopped);
  EXPECT_LT(std::abs(mass.speed), 0.1);
  EXPECT_EQ(mass.inputs.brake, 1.0);
  EXPECT_EQ(mass.state.integral, 0.0);
}

TEST(SpeedControl, asked_again_at_the_same_time_answers_the_same) {
  Mass mass{SpeedControl(hold(8.0), test_car()), {}, {}, 3.0};
  for (int i = 0; i < 100; ++i) mass.step(1e-2, none);
  const SpeedState before = mass.state;
  const double throttle = mass.inputs.throttle;
  mass.control.press(before.time, 8.0 - before.error, mass.state, mass.inputs);
  EXPECT_EQ(mass.inputs.throttle, throttle);
  EXPECT_EQ(mass.state.integral, before.integral);
}
