// Limits of the whole HMMWV on hard ground: the steepest slope that it climbs, and tipping with the higher centre of
// mass.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/vehicle/verification/drive.hpp"
#include "tests/verification/record.hpp"

using namespace furrow;
using namespace furrow::testing;
using vehicle::VehicleInputs;

namespace {

/// Centre of mass of the whole vehicle, relative to the middle of the rear axle's wheels on the ground, m.
Vec3 center_of_mass(const Drive& d) {
  Vec3 sum = Vec3::Zero();
  const vehicle::System& system = d.car.system();
  for (int i = 0; i < system.body_count(); ++i) sum += system.body(i).mass * system.body(i).state.position;
  const Vec3 rear = 0.5 * (d.car.rim(2).position + d.car.rim(3).position);
  return sum / d.car.mass() - Vec3(rear.x(), rear.y(), 0.0);
}

/// Distance uphill within the last two of eight seconds at full throttle from rest, m.
double climbs(double grade) {
  Drive d("hmmwv.json", {.grade = grade, .slip_width = 0.4, .step = 1e-3});
  double before = 0.0;
  for (long i = 0; i < d.steps(8.0); ++i) {
    if (i == d.steps(6.0)) before = d.car.origin().x();
    d.step(full_throttle());
  }
  return d.car.origin().x() - before;
}

struct Lift {
  double side = 0.0;  // over the weight, when both inner wheels carry no load; 0: never
  double most = 0.0;
};

/// At 15 m/s, the steering wheel turned to its stop within 5 s.
Lift turn_in(const char* file) {
  Drive d(file);
  d.begin(15.0);
  Lift lift;
  for (long i = 0; i < d.steps(6.0); ++i) {
    VehicleInputs inputs;
    inputs.throttle = 0.35;
    inputs.steering = std::min(1.0, 0.2 * i * d.options.step);
    d.step(inputs);
    lift.most = std::max(lift.most, d.side());
    if (lift.side == 0.0 && d.load(0) == 0.0 && d.load(2) == 0.0) lift.side = d.side();
  }
  return lift;
}

}  // namespace

// Rigid vehicles tip later, at half their track over the height of their centre of mass; on springs it moves outwards.
TEST(Performance, tips_before_it_slides_only_with_the_higher_centre_of_mass) {
  const Lift low = turn_in("hmmwv.json"), high = turn_in("hmmwv_tr.json");
  const Drive d("hmmwv_tr.json");
  const double threshold = 0.5 * (d.car.rim(0).position - d.car.rim(1).position).norm() / center_of_mass(d).z();
  EXPECT_EQ(low.side, 0.0);
  verification::verify("HMMWV turns in at 15 m/s and keeps a wheel of the inner side on the ground",
                       "largest side force over weight", low.most, d.contacts[0].friction, 0.05, "it slides");
  EXPECT_LT(high.side, 0.9);
  verification::verify("HMMWV with the higher centre of mass turns in at 15 m/s",
                       "side force over weight when the inner wheels leave the ground", high.side, threshold, 0.25,
                       "half track over height of a rigid vehicle");
}

// Open differentials give each wheel the same
// torque, and uphill the front axle is the lighter one:
//   tan θ = 2 μ (f − tan θ h/L),  f its share of the weight on level ground
TEST(Performance, climbs_until_its_front_axle_slips) {
  double goes = 0.3, stays = 0.9;
  while (stays - goes > 0.01) {
    const double grade = 0.5 * (goes + stays);
    (climbs(grade) > 0.05 ? goes : stays) = grade;
  }
  const Drive d("hmmwv.json");
  const double base = d.car.rim(0).position.x() - d.car.rim(2).position.x(), friction = d.contacts[0].friction;
  const Vec3 c = center_of_mass(d);
  const double steepest = 2.0 * friction * c.x() / base / (1.0 + 2.0 * friction * c.z() / base);
  verification::verify("HMMWV at full throttle on friction 0.9", "steepest slope that it climbs", goes, steepest, 0.12,
                       "grip of the front axle");
}
