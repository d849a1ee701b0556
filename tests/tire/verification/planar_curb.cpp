#include "tests/tire/verification/planar_curb.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tire/planar/planar_static.hpp"

namespace furrow::test {
namespace {

constexpr double kGravity = 9.81, kFelt = 0.02;  // m/s²; change of force, over the load, that counts as contact

struct Mass {
  double y = 0.0, v = 0.0;
  void push(double acceleration, double h) { v += acceleration * h, y += v * h; }
};

double suspension(const QuarterCar& car, const Mass& axle, const Mass& body) {
  return car.body * kGravity + car.spring * (axle.y - body.y) + car.damper * (axle.v - body.v);
}

/// Height of the wheel's centre at rest under the whole load.
double standing(const tire::PlanarParams& tire, double load) {
  tire::PlanarStatic wheel(tire, tire::PlanarGround::plate(tire.size.radius));
  double low = 0.0, high = 0.5 * (tire.size.radius - tire.size.rim_radius);
  for (int k = 0; k < 25; ++k) {
    const double middle = 0.5 * (low + high);
    EXPECT_TRUE(wheel.move_to({0.0, tire.size.radius - middle}).converged);
    (wheel.force() < load ? low : high) = middle;
  }
  return tire.size.radius - 0.5 * (low + high);
}

}  // namespace

CurbRun drive_over_curb(const tire::PlanarParams& tire, const QuarterCar& car, const std::vector<double>& pictures,
                        int every) {
  const double load = (car.axle + car.body) * kGravity, rest = standing(tire, load);
  tire::PlanarWheel wheel(tire, tire::PlanarGround::curb(car.curb, 10.0), {car.from, tire.size.radius},
                          {car.speed, 0.0}, car.speed / tire.size.radius, 0.0, kGravity);
  EXPECT_NEAR(wheel.mass(), car.axle, 0.02 * car.axle);
  Mass body{tire.size.radius - rest, 0.0}, simple_axle, simple_body;
  CurbRun run;
  run.mesh = wheel.mesh();
  run.step = wheel.step();
  tire::PlanarLink link;
  link.hold_x = true, link.velocity_x = car.speed;
  std::size_t next = 0;
  bool felt = false, simple_felt = false;
  for (long k = 0; wheel.centre().x < car.to; ++k) {
    const Mass axle{wheel.centre().z - rest, wheel.centre_velocity().z};
    const double force = suspension(car, axle, body);
    link.force_z = -force;
    wheel.link(link);
    if (const Outcome outcome = wheel.advance(); !outcome.ok) {
      ADD_FAILURE() << outcome.message("the wheel");
      break;
    }
    body.push(force / car.body - kGravity, run.step);
    const double x = wheel.centre().x, w = x > 0.0 ? car.curb : 0.0;
    const double simple_force = load + car.tire_spring * (w - simple_axle.y) - car.tire_damper * simple_axle.v;
    const double between = suspension(car, simple_axle, simple_body);
    simple_axle.push((simple_force - between) / car.axle - kGravity, run.step);
    simple_body.push(between / car.body - kGravity, run.step);
    bool at_curb = false;
    for (const tire::PlanarTouch& t : wheel.contact().touches()) at_curb = at_curb || t.push_x < -0.1;
    if (at_curb && !felt) felt = true, run.first_touch = x;
    if (std::abs(simple_force - load) > kFelt * load && !simple_felt) simple_felt = true, run.simple_first = x;
    if (wheel.contact().touches().empty()) run.airborne += x > -0.6 ? run.step : 0.0;
    if (next < pictures.size() && x >= pictures[next]) {
      run.pictures.push_back({x, wheel.motion().state().x});
      ++next;
    }
    if (k % every == 0)
      run.lines.push_back({x, wheel.centre().z - rest, body.y, wheel.contact().force_z(), simple_axle.y, simple_force});
  }
  return run;
}

}  // namespace furrow::test
