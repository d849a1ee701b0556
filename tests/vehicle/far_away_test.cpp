// Far from the origin positions are rounded more. A run must not end there because constraints or dampers cannot be
// satisfied as exactly as near the origin.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/vehicle/shipped.hpp"
#include "tests/vehicle/verification/simple_ground.hpp"

using namespace furrow;
using namespace furrow::testing;

TEST(FarAway, the_hmmwv_drives_brakes_and_stands) {
  for (const double x : {300.0, 3e3, 3e4}) {
    vehicle::Vehicle car(shipped("hmmwv.json"));
    add_tires(car);
    const std::vector<GroundContact> contacts(car.wheel_count());
    put_on_ground(car, contacts.front());
    car.move(Vec3(x, -x, 0.0));
    const double z = car.origin().z();
    for (int i = 0; i < 1800; ++i) {
      vehicle::VehicleInputs inputs;
      inputs.throttle = i < 600 ? 0.6 : 0.0;
      inputs.brake = i < 600 ? 0.0 : 0.3;
      inputs.steering = 0.5 * std::sin(5e-3 * i);
      car.set_inputs(inputs);
      for (int k = 0; k < car.wheel_count(); ++k) car.set_wrench(k, contacts[k].roll(car.rim(k), 4.0));
      const Outcome outcome = car.step(1e-3);
      ASSERT_TRUE(outcome.ok) << outcome.message("HMMWV") << " at step " << i << ", " << x << " m from the origin";
    }
    EXPECT_LE(car.system().max_violation(), std::max(1e-11, 8.0 * 2.3e-16 * (x + 10.0)));
    EXPECT_NEAR(car.origin().z(), z, 0.02);
  }
}
