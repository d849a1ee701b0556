// The quarter car: transfer function against the linear model's closed form, accounts, masses, exact continuation.
#include <gtest/gtest.h>
#include <algorithm>

#include <array>
#include <cmath>
#include <complex>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>

#include "protocol/core/error.hpp"
#include "rigs/quarter_car_rig.hpp"
#include "rigs/quarter_car_spec.hpp"
#include "vehicle/analysis/quarter_car.hpp"

namespace furrow::rigs::quarter_car_test {
namespace {

constexpr double kRadius = 0.5, kTireMass = 40.0, kHeight = 0.5;  // m, kg, m

QuarterCarOptions car() {
  QuarterCarOptions o;
  o.speed = 0.0;
  o.ramp = 0.0;
  o.touchdown_time = 0.0;
  o.lowering_speed = 0.4;
  o.body_mass = 400.0;
  o.unsprung_mass = 10.0;
  o.suspension_stiffness = 20e3;
  o.suspension_damping = 1500.0;
  o.rim_mass = 10.0;
  o.rim_spin_inertia = 1.0;
  o.rim_diametral_inertia = 0.5;
  return o;
}

std::unique_ptr<Rig> placed(const QuarterCarOptions& options) {
  auto rig = make_quarter_car(options);
  rig->add_tire_mass(0, {kTireMass, Vec3(1.0, 2.0, 1.0).asDiagonal()}, kRadius);
  rig->place(std::array{kHeight});
  return rig;
}

double measured(const Rig& rig, std::string_view column) {
  const Subject wheel = rig.subjects().front();
  std::vector<double> values(wheel.columns.size());
  rig.measure(0, values);
  return LineView{wheel.columns, values}[column];
}

constexpr vehicle::QuarterCarParams kLinear{400.0, 60.0, 20e3, 1500.0, 180e3, 300.0};

/// Amplitude and phase of body and wheel on a sine after the free motion has died out, by Fourier's integrals over two
/// periods.
vehicle::QuarterCarResponse driven(double omega) {
  const auto rig = placed(car());
  const double period = 2.0 * std::numbers::pi / omega, amplitude = 0.01;
  const int per_period = std::max(400, static_cast<int>(period / 2e-4));
  const double h = period / per_period;
  const int settle = static_cast<int>(std::ceil(6.0 / period)) * per_period;
  vehicle::QuarterCarResponse sum{};
  for (int k = 0; k < settle + 2 * per_period; ++k) {
    const double t = k * h, middle = t + 0.5 * h;
    const RimState rim = rig->rim(0);
    const double rise = rim.position.z() + 0.5 * h * rim.velocity.z() - kHeight;
    Wrench wrench;
    wrench.force.z() = 460.0 * kStandardGravity +
                       kLinear.tire_stiffness * (amplitude * std::cos(omega * middle) - rise) +
                       kLinear.tire_damping * (-amplitude * omega * std::sin(omega * middle) - rim.velocity.z());
    EXPECT_TRUE(rig->advance({&wrench, 1}, h, 1).ok);
    if (k < settle) continue;
    const std::complex<double> turn = std::polar(1.0 / per_period / amplitude, -omega * (t + h));
    sum.wheel += turn * (rig->rim(0).position.z() - kHeight);
    sum.body += turn * measured(*rig, "body_height_m");
  }
  return sum;
}

TEST(QuarterCar, follows_the_transfer_function_of_the_linear_quarter_car) {
  for (const double hertz : {0.5, 1.1, 3.0, 9.0, 15.0}) {
    const double omega = 2.0 * std::numbers::pi * hertz;
    const vehicle::QuarterCarResponse exact = quarter_car_response(kLinear, omega), found = driven(omega);
    EXPECT_LT(std::abs(found.wheel - exact.wheel), 0.01 * std::abs(exact.wheel)) << hertz << " Hz";
    EXPECT_LT(std::abs(found.body - exact.body), 0.01 * std::abs(exact.body)) << hertz << " Hz";
  }
}

TEST(QuarterCar, the_closed_form_has_the_limits_of_slow_and_of_fast_roads) {
  const vehicle::QuarterCarResponse slow = quarter_car_response(kLinear, 1e-4);
  EXPECT_NEAR(std::abs(slow.body - 1.0), 0.0, 1e-6);
  EXPECT_NEAR(std::abs(slow.wheel - 1.0), 0.0, 1e-6);
  EXPECT_NEAR(std::abs(slow.tire_force), 0.0, 1e-4);
  EXPECT_LT(std::abs(quarter_car_response(kLinear, 1e4).body), 1e-5);
  // Without dampers and on a rigid tire the body is an oscillator on its spring.
  vehicle::QuarterCarParams hard = kLinear;
  hard.damping = hard.tire_damping = 0.0, hard.tire_stiffness = 1e12;
  const double omega = 3.0, natural = hard.stiffness / hard.body_mass;
  EXPECT_NEAR(quarter_car_response(hard, omega).body.real(), natural / (natural - omega * omega), 1e-6);
  EXPECT_NEAR(vehicle::usual_stiffness(400.0) / 400.0, std::pow(3.0 * std::numbers::pi, 2), 1e-9);
  EXPECT_NEAR(vehicle::usual_damping(400.0, 400.0), 240.0, 1e-12);
}

TEST(QuarterCar, accounts_of_energy_and_momentum_close) {
  QuarterCarOptions options = car();
  options.speed = 3.0, options.ramp = 0.1, options.touchdown_time = 0.2;
  const auto rig = placed(options);
  const RigAccounts start = rig->accounts();
  for (int k = 0; k < 5000; ++k) {
    const double t = k * 1e-4;
    Wrench wrench;
    wrench.force = Vec3(-200.0 * std::sin(30.0 * t), 40.0, 4500.0 + 2000.0 * std::sin(50.0 * t));
    wrench.moment = Vec3(3.0, 60.0, 8.0);
    ASSERT_TRUE(rig->advance({&wrench, 1}, 1e-4, 1).ok);
  }
  const RigAccounts end = rig->accounts();
  const double work = std::abs(end.tow_work) + std::abs(end.tire_work) + end.damper_loss;
  EXPECT_LT(std::abs(end.drive_work + end.tow_work + end.guide_work + end.tire_work - end.damper_loss -
                     (end.stored() - start.stored())),
            1e-5 * work);
  const Vec3 left = end.momentum - start.momentum - end.gravity_impulse - end.guide_impulse - end.tire_impulse;
  EXPECT_LT(left.norm(), 1e-8 * end.tire_impulse.norm());
  EXPECT_NEAR(rig->report(0).speed, 3.0, 1e-9);
}

TEST(QuarterCar, it_stands_on_its_spring_as_it_was_placed) {
  const auto rig = placed(car());
  Wrench weight;
  weight.force.z() = 460.0 * kStandardGravity;
  for (int k = 0; k < 1000; ++k) ASSERT_TRUE(rig->advance({&weight, 1}, 1e-3, 1).ok);
  EXPECT_NEAR(rig->rim(0).position.z(), kHeight, 1e-9);
  EXPECT_NEAR(measured(*rig, "suspension_force_N"), 400.0 * kStandardGravity, 1e-5);
  EXPECT_NEAR(rig->report(0).load(), 460.0 * kStandardGravity, 1e-9);
}

TEST(QuarterCar, a_restored_rig_continues_bit_for_bit) {
  QuarterCarOptions options = car();
  options.speed = 3.0, options.ramp = 0.05, options.touchdown_time = 0.02;
  const auto one = placed(options);
  const auto go = [](Rig& rig, int from, int to) {
    for (int k = from; k < to; ++k) {
      Wrench wrench;
      wrench.force = Vec3(-3.0 * k, 10.0, 4000.0 + 5.0 * k), wrench.moment.y() = 0.1 * k;
      ASSERT_TRUE(rig.advance({&wrench, 1}, 1e-4, 2).ok);
    }
  };
  go(*one, 0, 150);
  Archive archive;
  one->save(archive);
  auto other = make_quarter_car(options);
  other->add_tire_mass(0, {kTireMass, Vec3(1.0, 2.0, 1.0).asDiagonal()}, kRadius);
  other->restore(archive);
  go(*one, 150, 400);
  go(*other, 150, 400);
  EXPECT_EQ(one->rim(0).position, other->rim(0).position);
  EXPECT_EQ(one->rim(0).angular_velocity, other->rim(0).angular_velocity);
  const auto subjects = one->subjects();
  for (const Column& column : subjects.front().columns)
    EXPECT_EQ(measured(*one, column.name), measured(*other, column.name)) << column.name;
  EXPECT_EQ(one->accounts().damper_loss, other->accounts().damper_loss);
}

const ReadContext kContext{"s.json", "rig"};

MountedTire tire() {
  MountedTire t;
  t.radius = kRadius, t.mass = kTireMass, t.file = "tire.json";
  t.rim.mass = 10.0, t.rim.spin_inertia = 1.0, t.rim.carrier_mass = 400.0;
  return t;
}

std::string complaint(const std::function<void()>& what) {
  try {
    what();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::bad_input);
    return error.what();
  }
  return "";
}

TEST(QuarterCar, what_is_open_comes_from_the_tires_file) {
  const QuarterCarOptions full = mounted({}, tire(), kContext);
  EXPECT_EQ(full.body_mass, 400.0);
  EXPECT_EQ(full.rim_diametral_inertia, 0.5);
  EXPECT_NEAR(full.unsprung_mass, 0.1, 1e-15);
  EXPECT_NEAR(full.suspension_stiffness, vehicle::usual_stiffness(400.0), 1e-9);
  QuarterCarOptions loaded;
  loaded.load = 3000.0;
  EXPECT_NEAR(mounted(loaded, tire(), kContext).body_mass, 3000.0 / kStandardGravity - 50.1, 1e-9);
  loaded.load = 400.0;
  EXPECT_NE(
      complaint([&] { mounted(loaded, tire(), kContext); }).find("s.json: key 'rig.load': is 400 N, expected above"),
      std::string::npos);
  MountedTire bare = tire();
  bare.rim = {};
  EXPECT_NE(complaint([&] {
              mounted({}, bare, kContext);
            }).find("s.json: key 'rig.load': is missing and so is rig.rim_mass, rig.rim_spin_inertia, expected here"),
            std::string::npos);
  EXPECT_EQ(complaint([] {
              read_quarter_car({{"load", 1.0}, {"body_mass", 2.0}}, kContext);
            }),
            "s.json: key 'rig.load': is given beside 'rig.body_mass', expected one of the two");
}

}  // namespace
}  // namespace furrow::rigs::quarter_car_test
