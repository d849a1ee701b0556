// The half car: the closed form against that of two quarter cars and of a rigid body on springs, the rig against the
// closed form on sines and on the heights of a road, accounts, masses, exact continuation.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>

#include <Eigen/LU>

#include "protocol/core/error.hpp"
#include "rigs/half_car_rig.hpp"
#include "rigs/half_car_spec.hpp"
#include "vehicle/analysis/half_car.hpp"
#include "vehicle/analysis/quarter_car.hpp"

namespace furrow::rigs::half_car_test {
namespace {

using std::numbers::pi;
using vehicle::HalfCarParams;

constexpr double kRadius = 0.3, kTireMass = 8.0, kHeight = 0.3;  // m, kg, m
constexpr double kWheelbase = 2.6, kShare = 0.55;                // m, of the front

/// Unlike at front and rear, and coupled.
HalfCarOptions car() {
  HalfCarOptions o;
  o.speed = 0.0;
  o.ramp = 0.0;
  o.touchdown_time = 0.0;
  o.lowering_speed = 0.4;
  o.wheelbase = kWheelbase;
  o.front_share = kShare;
  o.body_mass = 700.0;
  o.pitch_inertia = 900.0;
  o.unsprung_mass = 12.0;
  o.suspension_stiffness = 22e3, o.suspension_damping = 1600.0;
  o.rear_suspension_stiffness = 26e3, o.rear_suspension_damping = 1500.0;
  o.rim_mass = 15.0;
  o.rim_spin_inertia = 0.6;
  o.rim_diametral_inertia = 0.3;
  return o;
}

HalfCarParams linear(const HalfCarOptions& o = car()) {
  const double wheel = o.unsprung_mass + o.rim_mass + kTireMass;
  return {o.body_mass,
          o.pitch_inertia,
          {o.wheelbase * (1.0 - o.front_share), wheel, o.suspension_stiffness, o.suspension_damping, 180e3, 300.0},
          {o.wheelbase * o.front_share, wheel, o.rear_suspension_stiffness, o.rear_suspension_damping, 170e3, 250.0}};
}

TEST(HalfCar, is_two_quarter_cars_where_the_pitch_inertia_is_mass_times_both_distances) {
  HalfCarParams car = linear();
  const double a = car.front.distance, b = car.rear.distance, delay = 0.2;
  car.pitch_inertia = car.body_mass * a * b;
  for (const double hertz : {0.3, 1.2, 4.0, 11.0, 25.0}) {
    const double omega = 2.0 * pi * hertz;
    const auto quarter = [&](const vehicle::HalfCarAxle& axle, double share) {
      return vehicle::quarter_car_response({car.body_mass * share, axle.wheel_mass, axle.stiffness, axle.damping,
                                            axle.tire_stiffness, axle.tire_damping},
                                           omega);
    };
    const vehicle::QuarterCarResponse front = quarter(car.front, b / (a + b)), rear = quarter(car.rear, a / (a + b));
    const std::complex<double> late = std::polar(1.0, -omega * delay);
    const vehicle::HalfCarResponse half = vehicle::half_car_response(car, omega, delay);
    EXPECT_LT(std::abs(half.body_front - front.body), 1e-11) << hertz;
    EXPECT_LT(std::abs(half.wheel_front - front.wheel), 1e-11) << hertz;
    EXPECT_LT(std::abs(half.body_rear - late * rear.body), 1e-11) << hertz;
    EXPECT_LT(std::abs(half.wheel_rear - late * rear.wheel), 1e-11) << hertz;
    // The centre lies between the axles.
    EXPECT_LT(std::abs(half.body - (b * half.body_front + a * half.body_rear) / (a + b)), 1e-11);
    EXPECT_LT(std::abs(half.pitch - (half.body_rear - half.body_front) / (a + b)), 1e-11);
  }
}

TEST(HalfCar, on_hard_tires_has_the_two_frequencies_of_a_body_on_two_springs) {
  HalfCarParams car = linear();
  car.front.tire_stiffness = car.rear.tire_stiffness = 1e11;
  const double a = car.front.distance, b = car.rear.distance, kf = car.front.stiffness, kr = car.rear.stiffness;
  // Mitschke, Wallentowitz: (Ω_y² − ω²)(Ω_θ² − ω²) = (b k_r − a k_f)²/(m J).
  const double bounce = (kf + kr) / car.body_mass, pitch = (a * a * kf + b * b * kr) / car.pitch_inertia,
               coupled = std::pow(b * kr - a * kf, 2) / (car.body_mass * car.pitch_inertia);
  const double mean = 0.5 * (bounce + pitch), half = std::sqrt(std::pow(0.5 * (bounce - pitch), 2) + coupled);
  const vehicle::HalfCarModes modes = vehicle::half_car_modes(car);
  EXPECT_NEAR(modes.frequencies[0], std::sqrt(mean - half) / (2.0 * pi), 1e-6);
  EXPECT_NEAR(modes.frequencies[1], std::sqrt(mean + half) / (2.0 * pi), 1e-6);
}

TEST(HalfCar, its_modes_diagonalise_mass_and_stiffness_and_its_response_peaks_at_them_without_dampers) {
  HalfCarParams car = linear();
  const vehicle::HalfCarMatrices m = vehicle::half_car_matrices(car);
  const vehicle::HalfCarModes modes = vehicle::half_car_modes(car);
  EXPECT_LT((modes.shapes.transpose() * m.mass * modes.shapes - Eigen::Matrix4d::Identity()).norm(), 1e-12);
  const Eigen::Vector4d squares = (2.0 * pi * modes.frequencies).array().square();
  EXPECT_LT((m.stiffness * modes.shapes - m.mass * modes.shapes * squares.asDiagonal()).norm(), 1e-7);
  EXPECT_NEAR(squares.prod() / (m.stiffness.determinant() / m.mass.determinant()), 1.0, 1e-10);
  for (vehicle::HalfCarAxle* axle : {&car.front, &car.rear}) axle->damping = axle->tire_damping = 0.0;
  for (int k = 0; k < 4; ++k)
    EXPECT_GT(
        std::abs(vehicle::half_car_response(car, 2.0 * pi * modes.frequencies[k] * (1.0 + 1e-9), 0.1).wheel_front),
        1e4);
}

TEST(HalfCar, follows_a_slow_road_and_filters_by_its_wheelbase) {
  const vehicle::HalfCarResponse slow = vehicle::half_car_response(linear(), 1e-4, 0.0);
  EXPECT_LT(std::abs(slow.body - 1.0), 1e-6);
  EXPECT_LT(std::abs(slow.pitch), 1e-6);
  // Alike at front and rear: half a wave between the axles does not heave the body, a whole one does not pitch it.
  HalfCarParams car = linear();
  car.rear = car.front;
  const double omega = 2.0 * pi * 3.0;
  EXPECT_LT(std::abs(vehicle::half_car_response(car, omega, pi / omega).body), 1e-13);
  EXPECT_LT(std::abs(vehicle::half_car_response(car, omega, 2.0 * pi / omega).pitch), 1e-13);
  EXPECT_GT(std::abs(vehicle::half_car_response(car, omega, pi / omega).pitch), 0.01);
}

std::unique_ptr<Rig> made(const HalfCarOptions& options) {
  auto rig = make_half_car(options);
  for (const int k : {0, 1}) rig->add_tire_mass(k, {kTireMass, Vec3(0.4, 0.6, 0.4).asDiagonal()}, kRadius);
  return rig;
}

std::unique_ptr<Rig> placed(const HalfCarOptions& options) {
  auto rig = made(options);
  rig->place(std::array{kHeight, kHeight});
  return rig;
}

double measured(const Rig& rig, int subject, std::string_view column) {
  const Subject what = rig.subjects().at(subject);
  std::vector<double> values(what.columns.size());
  rig.measure(subject, values);
  return LineView{what.columns, values}[column];
}

/// A step on linear tires that know of the road only its height and its rate under the wheels' centres.
using Road = std::function<std::array<double, 2>(double time)>;
void step_on_springs(Rig& rig, const HalfCarParams& car, const Road& front, double delay, double t, double h) {
  std::array<Wrench, 2> wrenches;
  for (const int k : {0, 1}) {
    const vehicle::HalfCarAxle &axle = k == 0 ? car.front : car.rear, &other = k == 0 ? car.rear : car.front;
    const double share = other.distance / (axle.distance + other.distance);
    const RimState rim = rig.rim(k);
    const double rise = rim.position.z() + 0.5 * h * rim.velocity.z() - kHeight;
    const auto [height, rate] = front(t + 0.5 * h - (k == 0 ? 0.0 : delay));
    wrenches[k].force.z() = (share * car.body_mass + axle.wheel_mass) * kStandardGravity +
                            axle.tire_stiffness * (height - rise) + axle.tire_damping * (rate - rim.velocity.z());
  }
  ASSERT_TRUE(rig.advance(wrenches, h, 1).ok);
}

TEST(HalfCar, follows_the_transfer_function_of_the_linear_half_car) {
  for (const double hertz : {0.6, 1.3, 3.0, 10.0}) {
    const HalfCarParams car = linear();
    const auto rig = placed(half_car_test::car());
    const double omega = 2.0 * pi * hertz, period = 1.0 / hertz, amplitude = 0.005, delay = 0.13;
    const int per_period = std::max(400, static_cast<int>(period / 1e-3));
    const double h = period / per_period;
    const int settle = static_cast<int>(std::ceil(4.0 / period)) * per_period;
    const Road road = [&](double t) {
      return std::array{amplitude * std::cos(omega * t), -amplitude * omega * std::sin(omega * t)};
    };
    vehicle::HalfCarResponse found{};
    for (int k = 0; k < settle + per_period; ++k) {
      step_on_springs(*rig, car, road, delay, k * h, h);
      if (k < settle) continue;
      const std::complex<double> turn = std::polar(2.0 / per_period / amplitude, -omega * (k + 1) * h);
      found.body += turn * measured(*rig, 2, "body_height_m");
      found.pitch += turn * measured(*rig, 2, "pitch_rad");
      found.body_front += turn * measured(*rig, 0, "body_height_m");
      found.wheel_rear += turn * (rig->rim(1).position.z() - kHeight);
    }
    const vehicle::HalfCarResponse exact = vehicle::half_car_response(car, omega, delay);
    EXPECT_LT(std::abs(found.body - exact.body), 0.01 * std::abs(exact.body)) << hertz << " Hz";
    EXPECT_LT(std::abs(found.pitch - exact.pitch), 0.01 * std::abs(exact.pitch)) << hertz << " Hz";
    EXPECT_LT(std::abs(found.body_front - exact.body_front), 0.01 * std::abs(exact.body_front)) << hertz << " Hz";
    EXPECT_LT(std::abs(found.wheel_rear - exact.wheel_rear), 0.01 * std::abs(exact.wheel_rear)) << hertz << " Hz";
  }
}

/// (1) of half_car.hpp by Runge and Kutta's rule on the heights of a road: what the rig must do on the same heights.
TEST(HalfCar, on_the_heights_of_a_road_does_what_the_linear_equations_do) {
  const HalfCarParams car = linear();
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
  const vehicle::HalfCarMatrices m = vehicle::half_car_matrices(car);
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
  const auto rig = placed(half_car_test::car());
  State s = State::Zero();
  double wrong = 0.0, whole = 0.0, wrong_pitch = 0.0, whole_pitch = 0.0;
  for (int k = 0; k < 8000; ++k) {
    const double t = k * h;
    const State a = slope(t, s), b = slope(t + 0.5 * h, s + 0.5 * h * a), c = slope(t + 0.5 * h, s + 0.5 * h * b),
                d = slope(t + h, s + h * c), next = s + h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
    const double bounce = (next[4] - s[4]) / h, pitch = (next[5] - s[5]) / h;
    s = next;
    step_on_springs(*rig, car, road, delay, t, h);
    wrong += std::pow(measured(*rig, 2, "body_acceleration_m_per_s2") - bounce, 2), whole += bounce * bounce;
    wrong_pitch += std::pow(measured(*rig, 2, "pitch_acceleration_rad_per_s2") - pitch, 2);
    whole_pitch += pitch * pitch;
  }
  EXPECT_GT(std::sqrt(whole / 8000), 0.1);
  EXPECT_LT(std::sqrt(wrong / whole), 0.005);
  EXPECT_LT(std::sqrt(wrong_pitch / whole_pitch), 0.005);
}

TEST(HalfCar, stands_on_its_springs_as_it_was_placed) {
  const auto rig = placed(car());
  std::array<Wrench, 2> weights;
  for (const int k : {0, 1}) weights[k].force.z() = rig->report(k).load();
  EXPECT_NEAR(weights[0].force.z() + weights[1].force.z(), (700.0 + 2 * 35.0) * kStandardGravity, 1e-8);
  for (int k = 0; k < 500; ++k) ASSERT_TRUE(rig->advance(weights, 1e-3, 1).ok);
  for (const int k : {0, 1}) EXPECT_NEAR(rig->rim(k).position.z(), kHeight, 1e-9);
  EXPECT_NEAR(measured(*rig, 2, "pitch_rad"), 0.0, 1e-10);
  EXPECT_NEAR(measured(*rig, 0, "suspension_force_N"), 700.0 * kShare * kStandardGravity, 1e-5);
  EXPECT_NEAR(measured(*rig, 1, "suspension_force_N"), 700.0 * (1.0 - kShare) * kStandardGravity, 1e-5);
}

Wrench varying(int k, int wheel) {
  Wrench w;
  w.force = Vec3(-200.0 * std::sin(3e-3 * k + wheel), 20.0, 3500.0 + 1500.0 * std::sin(5e-3 * k + 2.0 * wheel));
  w.moment = Vec3(3.0, 40.0, 6.0);
  return w;
}

HalfCarOptions moving() {
  HalfCarOptions o = car();
  o.speed = 3.0, o.ramp = 0.1, o.touchdown_time = 0.15;
  return o;
}

TEST(HalfCar, accounts_of_energy_and_momentum_close) {
  const auto rig = placed(moving());
  const RigAccounts start = rig->accounts();
  for (int k = 0; k < 5000; ++k) {
    const std::array wrenches{varying(k, 0), varying(k, 1)};
    ASSERT_TRUE(rig->advance(wrenches, 1e-4, 1).ok);
  }
  const RigAccounts end = rig->accounts();
  const double work = std::abs(end.tow_work) + std::abs(end.tire_work) + end.damper_loss;
  EXPECT_LT(std::abs(end.drive_work + end.tow_work + end.guide_work + end.tire_work - end.damper_loss -
                     (end.stored() - start.stored())),
            1e-4 * work);
  const Vec3 left = end.momentum - start.momentum - end.gravity_impulse - end.guide_impulse - end.tire_impulse;
  EXPECT_LT(left.norm(), 1e-8 * end.tire_impulse.norm());
  for (const int k : {0, 1}) EXPECT_NEAR(rig->report(k).speed, 3.0, 1e-9);
  EXPECT_NEAR(rig->rim(0).position.x() - rig->rim(1).position.x(), kWheelbase, 1e-9);
  // The trolley pulls wheels and body; struts that lean with the body, here by up to 10 mrad, share some of it.
  EXPECT_NEAR(measured(*rig, 0, "trolley_force_N") + measured(*rig, 1, "trolley_force_N"),
              measured(*rig, 2, "trolley_force_N"), 30.0);
  EXPECT_NEAR(rig->report(0).vertical_momentum + rig->report(1).vertical_momentum, end.momentum.z(), 1e-6);
}

TEST(HalfCar, a_restored_rig_continues_bit_for_bit) {
  const auto go = [](Rig& rig, int from, int to) {
    for (int k = from; k < to; ++k) {
      const std::array wrenches{varying(k, 0), varying(k, 1)};
      ASSERT_TRUE(rig.advance(wrenches, 1e-4, 2).ok);
    }
  };
  const auto one = placed(moving());
  go(*one, 0, 250);
  Archive archive;
  one->save(archive);
  const auto other = made(moving());
  other->restore(archive);
  go(*one, 250, 500);
  go(*other, 250, 500);
  for (const int k : {0, 1}) {
    EXPECT_EQ(one->rim(k).position, other->rim(k).position);
    EXPECT_EQ(one->rim(k).angular_velocity, other->rim(k).angular_velocity);
  }
  const std::vector<Subject> subjects = one->subjects();
  for (int s = 0; s < 3; ++s)
    for (const Column& column : subjects[s].columns)
      EXPECT_EQ(measured(*one, s, column.name), measured(*other, s, column.name)) << column.name;
  EXPECT_EQ(one->accounts().damper_loss, other->accounts().damper_loss);
}

const ReadContext kContext{"s.json", "rig"};

MountedTire tire() {
  MountedTire t;
  t.radius = kRadius, t.mass = kTireMass, t.file = "tire.json";
  t.rim.mass = 10.0, t.rim.spin_inertia = 1.0, t.rim.carrier_mass = 350.0;
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

TEST(HalfCar, what_is_open_comes_from_the_tires_file) {
  const std::array tires{tire(), tire()};
  HalfCarOptions open;
  open.front_share = 0.6, open.wheelbase = 2.5;
  const HalfCarOptions full = mounted(open, tires, kContext);
  EXPECT_EQ(full.body_mass, 700.0);
  EXPECT_NEAR(full.pitch_inertia, 700.0 * 1.5 * 1.0, 1e-9);
  EXPECT_NEAR(full.suspension_stiffness, vehicle::usual_stiffness(420.0), 1e-9);
  EXPECT_NEAR(full.rear_suspension_stiffness, vehicle::usual_stiffness(280.0), 1e-9);
  EXPECT_NEAR(full.rear_suspension_damping, vehicle::usual_damping(280.0, full.rear_suspension_stiffness), 1e-9);
  HalfCarOptions loaded;
  loaded.load = 6000.0;
  EXPECT_NEAR(mounted(loaded, tires, kContext).body_mass, 6000.0 / kStandardGravity - 2.0 * 18.1, 1e-9);
  loaded.load = 300.0;
  EXPECT_NE(
      complaint([&] { mounted(loaded, tires, kContext); }).find("s.json: key 'rig.load': is 300 N, expected above"),
      std::string::npos);
  MountedTire bare = tire();
  bare.rim = {};
  EXPECT_NE(complaint([&] {
              mounted({}, std::array{bare, bare}, kContext);
            }).find("s.json: key 'rig.load': is missing and so is rig.rim_mass, rig.rim_spin_inertia, expected here"),
            std::string::npos);
  EXPECT_EQ(complaint([] {
              read_half_car({{"load", 1.0}, {"body_mass", 2.0}}, kContext);
            }),
            "s.json: key 'rig.load': is given beside 'rig.body_mass', expected one of the two");
}

TEST(HalfCar, its_rear_axle_starts_a_wheelbase_behind_the_front_one) {
  const auto spec = read_half_car({{"wheelbase", 2.0}, {"speed", 4.0}, {"ramp", 0.0}}, kContext);
  spec->mount(std::array{tire(), tire()});
  const std::array<WheelSize, 2> sizes{WheelSize{kRadius, 0.2}, WheelSize{kRadius, 0.2}};
  spec->fill_starts(sizes, 1.0, 20.0, std::array{0.1, 0.1});
  const RigDescription d = spec->describe(sizes, 1.0);
  ASSERT_EQ(d.wheels.size(), 2u);
  EXPECT_NEAR(d.wheels[0].from, 2.4, 1e-12);
  EXPECT_NEAR(d.wheels[1].from, 0.4, 1e-12);
  EXPECT_NEAR(d.wheels[0].to, 6.4, 1e-12);
  EXPECT_EQ(d.wheels[1].name, "rear");
}

}  // namespace
}  // namespace furrow::rigs::half_car_test
