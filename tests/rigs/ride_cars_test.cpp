// Quarter car and half car: the closed forms against each other and their limits, the rigs against the closed forms on
// sines and on the heights of a road, values from the tires' files.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <functional>
#include <memory>
#include <numbers>

#include <Eigen/LU>
#include <nlohmann/json.hpp>

#include "rigs/half_car_spec.hpp"
#include "rigs/quarter_car_spec.hpp"
#include "rigs/ride_spec.hpp"
#include "tests/refusal.hpp"
#include "tests/rigs/linear_cars.hpp"
#include "tests/rigs/rig_probe.hpp"

namespace furrow::rigs::ride_cars_test {
namespace {

using namespace furrow::testing;
using std::numbers::pi;

constexpr double kRadius = 0.5, kTireMass = 40.0, kHeight = 0.5;  // m, kg, m
constexpr double kWheel = 60.0;                                   // with rim and tire, kg

template <class Options>
Options standing_car() {
  Options o;
  o.speed = o.ramp = o.touchdown_time = 0.0;
  o.lowering_speed = 0.4;
  o.body_mass = 400.0, o.unsprung_mass = 10.0;
  o.suspension_stiffness = 20e3, o.suspension_damping = 1500.0;
  o.rim_mass = 10.0, o.rim_spin_inertia = 1.0, o.rim_diametral_inertia = 0.5;
  return o;
}

QuarterCarOptions quarter() { return standing_car<QuarterCarOptions>(); }

/// A car with different front and rear, and coupled.
HalfCarOptions half() {
  auto o = standing_car<HalfCarOptions>();
  o.wheelbase = 2.6, o.front_share = 0.55;
  o.body_mass = 700.0, o.pitch_inertia = 900.0;
  o.rear_suspension_stiffness = 26e3, o.rear_suspension_damping = 1400.0;
  return o;
}

constexpr QuarterCarParams kQuarter{400.0, kWheel, 20e3, 1500.0, 180e3, 300.0};
constexpr HalfCarParams kHalf{
    700.0, 900.0, {2.6 * 0.45, kWheel, 20e3, 1500.0, 180e3, 300.0}, {2.6 * 0.55, kWheel, 26e3, 1400.0, 170e3, 250.0}};

std::unique_ptr<Rig> placed(std::unique_ptr<Rig> rig) {
  for (int k = 0; k < rig->wheel_count(); ++k)
    rig->add_tire_mass(k, {kTireMass, Vec3(1.0, 2.0, 1.0).asDiagonal()}, kRadius);
  rig->place(std::vector<double>(rig->wheel_count(), kHeight));
  return rig;
}

TEST(LinearQuarterCar, has_the_limits_of_slow_and_of_fast_roads) {
  const QuarterCarResponse slow = quarter_car_response(kQuarter, 1e-4);
  EXPECT_LT(std::abs(slow.body - 1.0), 1e-6);
  EXPECT_LT(std::abs(slow.wheel - 1.0), 1e-6);
  EXPECT_LT(std::abs(quarter_car_response(kQuarter, 1e4).body), 1e-5);
  // Without dampers and on a rigid tire the body is an oscillator on its spring.
  QuarterCarParams hard = kQuarter;
  hard.damping = hard.tire_damping = 0.0, hard.tire_stiffness = 1e12;
  const double omega = 3.0, natural = hard.stiffness / hard.body_mass;
  EXPECT_NEAR(quarter_car_response(hard, omega).body.real(), natural / (natural - omega * omega), 1e-6);
}

TEST(LinearHalfCar, is_two_quarter_cars_where_the_pitch_inertia_is_mass_times_both_distances) {
  HalfCarParams car = kHalf;
  const double a = car.front.distance, b = car.rear.distance, delay = 0.2;
  car.pitch_inertia = car.body_mass * a * b;
  for (const double hertz : {0.3, 1.2, 4.0, 11.0, 25.0}) {
    const double omega = 2.0 * pi * hertz;
    const auto one = [&](const HalfCarAxle& axle, double share) {
      return quarter_car_response({car.body_mass * share, axle.wheel_mass, axle.stiffness, axle.damping,
                                   axle.tire_stiffness, axle.tire_damping},
                                  omega);
    };
    const QuarterCarResponse front = one(car.front, b / (a + b)), rear = one(car.rear, a / (a + b));
    const std::complex<double> late = std::polar(1.0, -omega * delay);
    const HalfCarResponse both = half_car_response(car, omega, delay);
    EXPECT_LT(std::abs(both.body_front - front.body), 1e-11) << hertz;
    EXPECT_LT(std::abs(both.wheel_front - front.wheel), 1e-11) << hertz;
    EXPECT_LT(std::abs(both.body_rear - late * rear.body), 1e-11) << hertz;
    EXPECT_LT(std::abs(both.wheel_rear - late * rear.wheel), 1e-11) << hertz;
    EXPECT_LT(std::abs(both.body - (b * both.body_front + a * both.body_rear) / (a + b)), 1e-11);
    EXPECT_LT(std::abs(both.pitch - (both.body_rear - both.body_front) / (a + b)), 1e-11);
  }
}

TEST(LinearHalfCar, follows_a_slow_road_and_filters_by_its_wheelbase) {
  const HalfCarResponse slow = half_car_response(kHalf, 1e-4, 0.0);
  EXPECT_LT(std::abs(slow.body - 1.0), 1e-6);
  EXPECT_LT(std::abs(slow.pitch), 1e-6);
  // With equal front and rear, half a wave between the axles does not heave the body, and a whole wave does not pitch
  // it.
  HalfCarParams car = kHalf;
  car.rear = car.front;
  const double omega = 2.0 * pi * 3.0;
  EXPECT_LT(std::abs(half_car_response(car, omega, pi / omega).body), 1e-13);
  EXPECT_LT(std::abs(half_car_response(car, omega, 2.0 * pi / omega).pitch), 1e-13);
  EXPECT_GT(std::abs(half_car_response(car, omega, pi / omega).pitch), 0.01);
}

/// A step on linear tires that depend only on the road's height and its rate under the wheels' centres.
using Road = std::function<std::array<double, 2>(double time)>;
void step_on_springs(Rig& rig, const std::vector<HalfCarAxle>& axles, const Road& front, double delay, double t,
                     double h) {
  std::vector<Wrench> wrenches(axles.size());
  for (int k = 0; k < rig.wheel_count(); ++k) {
    const RimState rim = rig.rim(k);
    const double rise = rim.position.z() + 0.5 * h * rim.velocity.z() - kHeight;
    const auto [height, rate] = front(t + 0.5 * h - (k == 0 ? 0.0 : delay));
    wrenches[k].force.z() = rig.report(k).load() + axles[k].tire_stiffness * (height - rise) +
                            axles[k].tire_damping * (rate - rim.velocity.z());
  }
  ASSERT_TRUE(rig.advance(wrenches, h, 1).ok);
}

/// Amplitude and phase of the readings on a sine, after the free motion has died out, by Fourier's integral over a
/// period.
template <std::size_t n>
std::array<std::complex<double>, n> driven(Rig& rig, const std::vector<HalfCarAxle>& axles, double hertz, double delay,
                                           const std::function<std::array<double, n>(const Rig&)>& read) {
  const double omega = 2.0 * pi * hertz, period = 1.0 / hertz, amplitude = 0.005;
  const int per_period = std::max(400, static_cast<int>(period / 5e-4));
  const double h = period / per_period;
  const int settle = static_cast<int>(std::ceil(6.0 / period)) * per_period;
  const Road road = [&](double t) {
    return std::array{amplitude * std::cos(omega * t), -amplitude * omega * std::sin(omega * t)};
  };
  std::array<std::complex<double>, n> sum{};
  for (int k = 0; k < settle + per_period; ++k) {
    step_on_springs(rig, axles, road, delay, k * h, h);
    if (k < settle) continue;
    const std::complex<double> turn = std::polar(2.0 / per_period / amplitude, -omega * (k + 1) * h);
    const std::array<double, n> now = read(rig);
    for (std::size_t i = 0; i < n; ++i) sum[i] += turn * now[i];
  }
  return sum;
}

template <std::size_t n>
void expect_near(const std::array<std::complex<double>, n>& found, const std::array<std::complex<double>, n>& exact,
                 double hertz) {
  for (std::size_t i = 0; i < n; ++i)
    EXPECT_LT(std::abs(found[i] - exact[i]), 0.01 * std::abs(exact[i])) << i << " at " << hertz << " Hz";
}

TEST(QuarterCar, follows_the_transfer_function_of_the_linear_quarter_car) {
  for (const double hertz : {0.5, 1.1, 3.0, 9.0, 15.0}) {
    const auto rig = placed(make_quarter_car(quarter()));
    const QuarterCarResponse exact = quarter_car_response(kQuarter, 2.0 * pi * hertz);
    expect_near<2>(driven<2>(*rig, {{0.0, kWheel, 20e3, 1500.0, 180e3, 300.0}}, hertz, 0.0,
                             [](const Rig& r) {
                               return std::array{r.rim(0).position.z() - kHeight, measured(r, "body_height_m")};
                             }),
                   {exact.wheel, exact.body}, hertz);
  }
}

TEST(HalfCar, follows_the_transfer_function_of_the_linear_half_car) {
  for (const double hertz : {0.6, 1.3, 3.0, 10.0}) {
    const auto rig = placed(make_half_car(half()));
    const double delay = 0.13;
    const HalfCarResponse exact = half_car_response(kHalf, 2.0 * pi * hertz, delay);
    expect_near<4>(driven<4>(*rig, {kHalf.front, kHalf.rear}, hertz, delay,
                             [](const Rig& r) {
                               return std::array{measured(r, 2, "body_height_m"), measured(r, 2, "pitch_rad"),
                                                 measured(r, 0, "body_height_m"), r.rim(1).position.z() - kHeight};
                             }),
                   {exact.body, exact.pitch, exact.body_front, exact.wheel_rear}, hertz);
  }
}

/// (3) of linear_cars.hpp by the Runge–Kutta method on the heights of a road; the rig must agree on the same heights.
TEST(HalfCar, on_the_heights_of_a_road_does_what_the_linear_equations_do) {
  const HalfCarParams car = kHalf;
  const double delay = 0.21, h = 4e-4;
  const Road road = [](double t) {  // a sum of waves that does not repeat
    std::array<double, 2> sum{};
    for (int k = 1; k <= 12; ++k) {
      const double omega = 2.0 * pi * 0.37 * std::pow(1.41, k), size = 0.02 / omega;
      sum[0] += size * (std::sin(omega * t + k * k) - std::sin(k * k)) * std::min(1.0, t > 0.0 ? t : 0.0);
      sum[1] += size * omega * std::cos(omega * t + k * k) * std::min(1.0, t > 0.0 ? t : 0.0);
      if (t > 0.0 && t < 1.0) sum[1] += size * (std::sin(omega * t + k * k) - std::sin(k * k));
    }
    return sum;
  };
  const HalfCarMatrices m = half_car_matrices(car);
  const Eigen::Matrix4d inverse = m.mass.inverse();
  using State = Eigen::Matrix<double, 8, 1>;
  const auto slope = [&](double t, const State& s) {
    const auto [rf, vf] = road(t);
    const auto [rr, vr] = road(t - delay);
    Eigen::Vector4d push(0.0, 0.0, car.front.tire_stiffness * rf + car.front.tire_damping * vf,
                         car.rear.tire_stiffness * rr + car.rear.tire_damping * vr);
    State d;
    d << s.tail<4>(), inverse * (push - m.damping * s.tail<4>() - m.stiffness * s.head<4>());
    return d;
  };
  const auto rig = placed(make_half_car(half()));
  State s = State::Zero();
  double wrong = 0.0, whole = 0.0, wrong_pitch = 0.0, whole_pitch = 0.0;
  for (int k = 0; k < 8000; ++k) {
    const double t = k * h;
    const State a = slope(t, s), b = slope(t + 0.5 * h, s + 0.5 * h * a), c = slope(t + 0.5 * h, s + 0.5 * h * b),
                d = slope(t + h, s + h * c), next = s + h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
    const double bounce = (next[4] - s[4]) / h, pitch = (next[5] - s[5]) / h;
    s = next;
    step_on_springs(*rig, {car.front, car.rear}, road, delay, t, h);
    wrong += std::pow(measured(*rig, 2, "body_acceleration_m_per_s2") - bounce, 2), whole += bounce * bounce;
    wrong_pitch += std::pow(measured(*rig, 2, "pitch_acceleration_rad_per_s2") - pitch, 2);
    whole_pitch += pitch * pitch;
  }
  EXPECT_GT(std::sqrt(whole / 8000), 0.1);
  EXPECT_LT(std::sqrt(wrong / whole), 0.005);
  EXPECT_LT(std::sqrt(wrong_pitch / whole_pitch), 0.005);
}

TEST(RideCars, stand_on_their_springs_as_they_were_placed) {
  for (const bool two : {false, true}) {
    const auto rig = placed(two ? make_half_car(half()) : make_quarter_car(quarter()));
    std::vector<Wrench> weights(rig->wheel_count());
    double load = 0.0;
    for (int k = 0; k < rig->wheel_count(); ++k) load += weights[k].force.z() = rig->report(k).load();
    EXPECT_NEAR(load, (two ? 700.0 + 2 * kWheel : 400.0 + kWheel) * kStandardGravity, 1e-8);
    for (int i = 0; i < 1000; ++i) ASSERT_TRUE(rig->advance(weights, 1e-3, 1).ok);
    for (int k = 0; k < rig->wheel_count(); ++k) {
      const double share = two ? 700.0 * (k == 0 ? 0.55 : 0.45) : 400.0;
      EXPECT_NEAR(rig->rim(k).position.z(), kHeight, 1e-9);
      EXPECT_NEAR(measured(*rig, k, "suspension_force_N"), share * kStandardGravity, 1e-5);
    }
    if (two) {
      EXPECT_NEAR(measured(*rig, 2, "pitch_rad"), 0.0, 1e-10);
    }
  }
}

TEST(HalfCar, its_trolley_pulls_both_wheels_at_its_speed) {
  HalfCarOptions o = half();
  o.speed = 3.0, o.ramp = 0.1, o.touchdown_time = 0.15;
  const auto rig = placed(make_half_car(o));
  for (int i = 0; i < 5000; ++i) {
    std::array<Wrench, 2> wrenches;
    for (const int k : {0, 1})
      wrenches[k].force = Vec3(-200.0 * std::sin(3e-3 * i + k), 20.0, 3500.0 + 1500.0 * std::sin(5e-3 * i + 2.0 * k));
    ASSERT_TRUE(rig->advance(wrenches, 1e-4, 1).ok);
  }
  for (const int k : {0, 1}) EXPECT_NEAR(rig->report(k).speed, 3.0, 1e-9);
  EXPECT_NEAR(rig->rim(0).position.x() - rig->rim(1).position.x(), o.wheelbase, 1e-9);
  // Struts that lean with the body, here by up to 10 mrad, share some of the pull.
  EXPECT_NEAR(measured(*rig, 0, "trolley_force_N") + measured(*rig, 1, "trolley_force_N"),
              measured(*rig, 2, "trolley_force_N"), 30.0);
  EXPECT_NEAR(rig->report(0).vertical_momentum + rig->report(1).vertical_momentum, rig->accounts().momentum.z(), 1e-6);
}

const ReadContext kContext{"s.json", "rig"};

MountedTire tire() {
  MountedTire t;
  t.radius = kRadius, t.mass = kTireMass, t.file = "tire.json";
  t.rim.mass = 10.0, t.rim.spin_inertia = 1.0, t.rim.carrier_mass = 400.0;
  return t;
}

/// Parameters that both cars take from their `count` tires.
template <class Options, class Mount>
void expect_filled_in(int count, const Mount& mount) {
  const Options full = mount(Options(), tire());
  EXPECT_EQ(full.body_mass, count * 400.0);
  EXPECT_EQ(full.rim_diametral_inertia, 0.5);
  EXPECT_NEAR(full.unsprung_mass, 0.1, 1e-15);
  EXPECT_NEAR(full.suspension_stiffness, usual_stiffness(400.0), 1e-9);
  EXPECT_NEAR(full.suspension_damping, usual_damping(400.0, full.suspension_stiffness), 1e-9);
  Options loaded;
  loaded.load = count * 3000.0;
  EXPECT_NEAR(mount(loaded, tire()).body_mass, count * (3000.0 / kStandardGravity - 50.1), 1e-9);
  loaded.load = 300.0;
  expect_refused(ExitCode::bad_input, {"s.json: key 'rig.load': is 300 N, expected above "},
                 [&] { mount(loaded, tire()); });
  MountedTire bare = tire();
  bare.rim = {};
  expect_refused(ExitCode::bad_input,
                 {"s.json: key 'rig.load': is missing and so is rig.rim_mass, rig.rim_spin_inertia, expected here"},
                 [&] { mount(Options(), bare); });
}

TEST(QuarterCar, what_is_open_comes_from_the_tires_file) {
  EXPECT_NEAR(usual_stiffness(400.0) / 400.0, std::pow(3.0 * pi, 2), 1e-9);
  EXPECT_NEAR(usual_damping(400.0, 400.0), 240.0, 1e-12);
  expect_filled_in<QuarterCarOptions>(
      1, [](const QuarterCarOptions& o, const MountedTire& t) { return mounted(o, t, kContext); });
}

TEST(HalfCar, what_is_open_comes_from_the_tires_files) {
  const auto mount = [](const HalfCarOptions& o, const MountedTire& t) {
    return mounted(o, std::array{t, t}, kContext);
  };
  expect_filled_in<HalfCarOptions>(2, mount);
  HalfCarOptions open;
  open.front_share = 0.6, open.wheelbase = 2.5;
  const HalfCarOptions full = mount(open, tire());
  EXPECT_NEAR(full.pitch_inertia, 800.0 * 1.5 * 1.0, 1e-9);
  EXPECT_NEAR(full.suspension_stiffness, usual_stiffness(480.0), 1e-9);
  EXPECT_NEAR(full.rear_suspension_stiffness, usual_stiffness(320.0), 1e-9);
  EXPECT_NEAR(full.rear_suspension_damping, usual_damping(320.0, full.rear_suspension_stiffness), 1e-9);
}

TEST(HalfCar, its_rear_axle_starts_a_wheelbase_behind_the_front_one) {
  const auto spec = read_half_car({{"wheelbase", 2.0}, {"speed", 4.0}, {"ramp", 0.0}}, kContext);
  spec->mount(std::array{tire(), tire()});
  const std::array<WheelSize, 2> sizes{WheelSize{kRadius, 0.2}, WheelSize{kRadius, 0.2}};
  spec->fill_starts(sizes, 1.0, 20.0, std::array{0.1, 0.1});
  const RigDescription d = spec->describe(sizes, 1.0);
  ASSERT_EQ(d.wheels.size(), 2u);
  EXPECT_NEAR(d.wheels[0].from, 2.6, 1e-12);
  EXPECT_NEAR(d.wheels[1].from, 0.6, 1e-12);
  EXPECT_NEAR(d.wheels[0].to, 6.6, 1e-12);
  EXPECT_EQ(d.wheels[1].name, "rear");
}

}  // namespace
}  // namespace furrow::rigs::ride_cars_test
