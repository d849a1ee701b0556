// A whole vehicle free in space: engine, converter, shifts, steering, struts and brakes act only between its parts.
#include <gtest/gtest.h>

#include <numbers>

#include "tests/vehicle/hmmwv.hpp"
#include "vehicle/driveline/engine.hpp"
#include "vehicle/driveline/friction_coupling.hpp"
#include "vehicle/driveline/gearbox.hpp"
#include "vehicle/driveline/gears.hpp"
#include "vehicle/driveline/torque_converter.hpp"

using namespace furrow;
using namespace furrow::testing;
using vehicle::FrictionCoupling, vehicle::Table;

namespace {

struct Powered : Hmmwv {
  int crank, turbine, propeller, centre;
  vehicle::Engine engine;
  vehicle::TorqueConverter converter;
  vehicle::Gearbox gearbox;
  std::vector<FrictionCoupling> brakes;

  Powered()
      : Hmmwv(false, Vec3::Zero()),
        crank(shaft("crank", 1.1, Vec3::UnitX(), 150.0)),
        turbine(shaft("turbine", 0.3, Vec3::UnitX())),
        propeller(shaft("propeller", 0.5, Vec3::UnitX())),
        centre(shaft("centre", 0.6, Vec3::UnitX())),
        engine(system, "engine", crank,
               {Table("full", {{0, 400}, {160, 790}, {260, 560}, {283, -400}}),
                Table("losses", {{0, 0}, {300, -90}})}),
        converter(system, "converter", crank, turbine,
                  {Table("K", {{0, 15}, {0.75, 16}, {0.9, 18}, {1, 35}}),
                   Table("T", {{0, 2}, {0.75, 1.15}, {1, 1}})}),
        gearbox(system, "gearbox", turbine, propeller, {0.2, 0.4}, 0.2, 0) {
    const int front = shaft("front", 0.5, Vec3::UnitX()), rear = shaft("rear", 0.5, Vec3::UnitX());
    vehicle::add_gear(system, "transfer case", propeller, centre, 1.0);
    vehicle::add_differential(system, "centre differential", centre, front, rear);
    for (int axle = 0; axle < 2; ++axle) {
      const int box = shaft("box", 0.6, Vec3::UnitY());
      const int left = shaft("left", 0.4, Vec3::UnitY()), right = shaft("right", 0.4, Vec3::UnitY());
      vehicle::add_gear(system, "conical gear", axle == 0 ? front : rear, box, 0.2);
      vehicle::add_differential(system, "differential", box, left, right);
      vehicle::add_shaft_to_body(system, "hub", left, spindles[2 * axle], Vec3::UnitY());
      vehicle::add_shaft_to_body(system, "hub", right, spindles[2 * axle + 1], Vec3::UnitY());
    }
    for (int k = 0; k < 4; ++k)
      brakes.push_back(
          FrictionCoupling::brake(system, "brake", uprights[k], spindles[k], Vec3::UnitY(), 4000.0));
    system.assemble(0.0);
  }
  int shaft(const char* name, double inertia, const Vec3& axis, double speed = 0.0) {
    return system.add_shaft(name, inertia, chassis, axis, speed);
  }
};

}  // namespace

TEST(Vehicle, drive_shift_steering_and_brakes_leave_momentum_and_angular_momentum_of_the_whole_alone) {
  Powered car;
  vehicle::System& system = car.system;
  EXPECT_EQ(system.redundant_count(), 0);
  const Vec3 about(1.0, 2.0, -0.5);
  const Vec3 momentum = system.momentum(), angular = system.angular_momentum(about);
  double largest = 0.0, violation = 0.0, wheel_momentum = 0.0;
  car.engine.set_throttle(1.0);
  for (int i = 0; i < 1500; ++i) {
    const Outcome shift = i == 400 ? car.gearbox.shift(system, 1) : Outcome{};
    ASSERT_TRUE(shift.ok);
    if (i == 800) car.engine.set_throttle(0.0);
    if (i == 900)
      for (const FrictionCoupling& brake : car.brakes) brake.engage(system, 0.5);
    ASSERT_TRUE(car.gearbox.advance(system, 1e-3).ok);
    const Outcome outcome = system.step(1e-3);
    ASSERT_TRUE(outcome.ok) << outcome.message("vehicle") << " at step " << i;
    largest = std::max(largest, (system.angular_momentum(about) - angular).norm());
    violation = std::max(violation, system.max_violation());
    if (i == 880) wheel_momentum = 4 * 2.0 * system.body(car.spindles[0]).state.angular_velocity.norm();
  }
  EXPECT_GT(wheel_momentum, 100.0);  // N m s
  EXPECT_LT(largest, 1e-10 * wheel_momentum);
  EXPECT_LT((system.momentum() - momentum).norm(), 1e-9);
  EXPECT_LT(violation, 1e-11);
  for (const FrictionCoupling& brake : car.brakes) EXPECT_TRUE(brake.holds(system));
}
