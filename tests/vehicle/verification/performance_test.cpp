// What the whole HMMWV does on hard ground, on tires that push along the ground by their slip speed alone: top speed against
// the engine map, stopping distance, slopes that it climbs, and when the one with the higher centre of mass tips.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/vehicle/shipped.hpp"
#include "tests/vehicle/verification/simple_ground.hpp"
#include "tests/verification/record.hpp"

using namespace furrow;
using namespace furrow::testing;
using vehicle::Vehicle, vehicle::VehicleInputs;

namespace {

constexpr double kSlipWidth = 4.0, kStep = 2e-3;  // m/s; s

/// A vehicle on its ground.
struct Drive {
  Vehicle car;
  std::vector<GroundContact> contacts;

  explicit Drive(const char* file, double grade = 0.0) : car(shipped(file), gravity_on_slope(grade)) {
    add_tires(car);
    contacts.assign(car.wheel_count(), {});
    put_on_ground(car, contacts.front());
  }
  void begin(double speed) {
    car.begin_rolling(speed, std::vector<double>(car.wheel_count(), contacts[0].radius), 0);
  }
  double speed() const {
    const vehicle::Body& chassis = car.system().body(car.chassis());
    return chassis.state.velocity.dot(chassis.R * Vec3::UnitX());
  }
  double roll() const {
    const Mat3& R = car.system().body(car.chassis()).R;
    return std::atan2(R(2, 1), R(2, 2));
  }
  double load(int k) const { return contacts[k].load(car.rim(k)); }
  /// Side force of the ground over the weight.
  double side() const {
    Vec3 force = Vec3::Zero();
    double weight = 0.0;
    const Mat3& R = car.system().body(car.chassis()).R;
    for (int k = 0; k < car.wheel_count(); ++k) {
      const Vec3 one = contacts[k].roll(car.rim(k), kSlipWidth).force;
      force += one, weight += one.z();
    }
    return std::abs(force.dot(Vec3(-R(1, 0), R(0, 0), 0.0))) / weight;
  }
  void step(const VehicleInputs& inputs) {
    car.set_inputs(inputs);
    for (int k = 0; k < car.wheel_count(); ++k) car.set_wrench(k, contacts[k].roll(car.rim(k), kSlipWidth));
    const Outcome outcome = car.step(kStep);
    if (!outcome.ok) throw physics_error(outcome, "HMMWV");
  }
};

VehicleInputs full_throttle() {
  VehicleInputs inputs;
  inputs.throttle = 1.0;
  return inputs;
}

/// Centre of mass of all, against the middle of the wheels of the rear axle on the ground, m.
Vec3 center_of_mass(const Drive& d) {
  Vec3 sum = Vec3::Zero();
  const vehicle::System& system = d.car.system();
  for (int i = 0; i < system.body_count(); ++i) sum += system.body(i).mass * system.body(i).state.position;
  const Vec3 rear = 0.5 * (d.car.rim(2).position + d.car.rim(3).position);
  return sum / d.car.mass() - Vec3(rear.x(), rear.y(), 0.0);
}

/// Way that it makes uphill within the last two of eight seconds at full throttle from rest, m.
double climbs(double grade) {
  Drive d("hmmwv.json", grade);
  double before = 0.0;
  for (int i = 0; i < 8.0 / kStep; ++i) {
    if (i == std::lround(6.0 / kStep)) before = d.car.origin().x();
    d.step(full_throttle());
  }
  return d.car.origin().x() - before;
}

struct Lift {
  double side = 0.0;  // over the weight, when both inner wheels carry nothing; 0: never
  double most = 0.0;
};

/// At 15 m/s, the steering wheel turned to its stop within 5 s.
Lift turn_in(const char* file) {
  Drive d(file);
  d.begin(15.0);
  Lift lift;
  for (int i = 0; i < 6.0 / kStep; ++i) {
    VehicleInputs inputs;
    inputs.throttle = 0.35;
    inputs.steering = std::min(1.0, 0.2 * i * kStep);
    d.step(inputs);
    lift.most = std::max(lift.most, d.side());
    if (lift.side == 0.0 && d.load(0) == 0.0 && d.load(2) == 0.0) lift.side = d.side();
  }
  return lift;
}

}  // namespace

// Rigid vehicles tip later, at half their track over the height of their centre of mass; springs let it move outwards.
TEST(Performance, tips_before_it_slides_only_with_the_higher_centre_of_mass) {
  const Lift low = turn_in("hmmwv.json"), high = turn_in("hmmwv_tr.json");
  const Drive d("hmmwv_tr.json");
  const double threshold =
      0.5 * (d.car.rim(0).position - d.car.rim(1).position).norm() / center_of_mass(d).z();
  EXPECT_EQ(low.side, 0.0);
  EXPECT_GT(low.most, 0.85);  // it slides
  EXPECT_LT(high.side, 0.9);
  verification::verify("HMMWV with the higher centre of mass turns in at 15 m/s",
                       "side force over weight when the inner wheels leave the ground", high.side, threshold,
                       0.25, "half track over height of a rigid vehicle");
}

// At full grip, which no wheel has that spins as slowly as first gear lets it. Open differentials give each wheel the same
// torque, and uphill the front axle is the lighter one:
//   tan θ = 2 μ (f − tan θ h/L),  f its share of the weight on level ground
TEST(Performance, climbs_until_its_front_axle_slips) {
  double goes = 0.3, stays = 0.9;
  while (stays - goes > 0.01) {
    const double grade = 0.5 * (goes + stays);
    (climbs(grade) > 0.05 ? goes : stays) = grade;
  }
  const Drive d("hmmwv.json");
  const double base = d.car.rim(0).position.x() - d.car.rim(2).position.x(),
               friction = d.contacts[0].friction;
  const Vec3 c = center_of_mass(d);
  const double steepest = 2.0 * friction * c.x() / base / (1.0 + 2.0 * friction * c.z() / base);
  verification::verify("HMMWV at full throttle on friction 0.9", "steepest slope that it climbs", goes,
                       steepest, 0.12, "grip of the front axle");
  for (const double grade : {0.1, 0.2, 0.3, 0.4, 0.5}) EXPECT_GT(climbs(grade), 1.0) << grade;
}
