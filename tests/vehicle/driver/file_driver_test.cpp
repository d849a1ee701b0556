// Whole drivers: open loops, and continuation after saving.
#include "vehicle/driver/file_driver.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/protocol/fields_of.hpp"
#include "tests/vehicle/driver/bicycle.hpp"
#include "vehicle/driver/path_follower.hpp"
#include "vehicle/driver/speed_control.hpp"

using namespace furrow;
using namespace furrow::testing;
using namespace furrow::vehicle;

namespace {

/// All cases together: a path with bends that ends, a speed that cannot be reached, a stop on the way and a stop at the
/// end.
DriverSpec everything(const SteeringLaw& law) {
  DriverSpec spec;
  spec.inputs.gear = {{0.0, 1}, {2.0, gear_request::automatic}, {9.0, 2}};
  spec.speed.emplace();
  spec.speed->target = {{0.0, 0.0}, {0.5, 0.0}, {1.0, 12.0}, {8.0, 12.0}, {9.0, 0.0}, {18.0, 0.0}, {20.0, 6.0}};
  spec.path.emplace();
  spec.path->shape = WaypointPath{{{0, 0}, {10, 0}, {18, 6}, {30, 4}, {45, 15}, {60, 15}}};
  spec.path->steering = {law, 0.4};
  return spec;
}

constexpr double kStep = 1e-2;  // s
constexpr int kSteps = 2400;

/// A bicycle with mass and drag, which the brakes can hold.
void move(Bicycle& bicycle, const DriverInputs& inputs) {
  const DriverCar car = test_car();
  const double drag = 100.0 * bicycle.speed * bicycle.speed;
  const double force = inputs.throttle * car.drive_force - inputs.brake * car.brake_force - drag;
  bicycle.speed = std::max(0.0, bicycle.speed + kStep * force / car.mass);
  bicycle.roll(curvature_of(inputs, car), kStep);
}

}  // namespace

TEST(FileDriver, follows_its_tables) {
  DriverSpec spec;
  spec.inputs.throttle = {{0.5, 0.0}, {1.5, 1.0}};
  spec.inputs.brake = {{3.0, 0.25}};
  spec.inputs.steering = {{1.0, -0.5}, {2.0, 0.5}, {2.0 + 1e-9, 0.0}};
  spec.inputs.gear = {{1.0, gear_request::reverse}, {2.0, 3}, {4.0, gear_request::automatic}};
  spec.inputs.lock = {{1.0, 0}, {2.5, 1}, {3.5, 0}};
  const auto driver = make_driver(spec, test_car());
  const auto at = [&](double time) {
    DriverView view;
    view.time = time;
    return driver->drive(view);
  };
  EXPECT_EQ(at(0.0).throttle, 0.0);
  EXPECT_EQ(at(0.0).brake, 0.25);
  EXPECT_EQ(at(0.0).steering, -0.5);
  EXPECT_EQ(at(0.0).gear, gear_request::reverse);
  EXPECT_NEAR(at(1.25).throttle, 0.75, 1e-15);
  EXPECT_NEAR(at(1.25).steering, -0.25, 1e-15);
  EXPECT_EQ(at(1.999).gear, gear_request::reverse);
  EXPECT_EQ(at(2.0).gear, 3);
  EXPECT_EQ(at(2.1).steering, 0.0);
  EXPECT_FALSE(at(2.499).lock);
  EXPECT_TRUE(at(2.5).lock);
  EXPECT_FALSE(at(3.5).lock);
  EXPECT_EQ(at(5.0).throttle, 1.0);
  EXPECT_EQ(at(5.0).gear, gear_request::automatic);
}

TEST(FileDriver, without_a_table_does_nothing_and_leaves_the_gear) {
  DriverSpec spec;
  spec.inputs.steering = {{0.0, 0.1}};
  const auto driver = make_driver(spec, test_car());
  const DriverInputs inputs = driver->drive({});
  EXPECT_EQ(inputs.throttle, 0.0);
  EXPECT_EQ(inputs.brake, 0.0);
  EXPECT_EQ(inputs.gear, gear_request::automatic);
  EXPECT_FALSE(inputs.lock);
}

TEST(FileDriver, goes_on_bit_for_bit_wherever_it_was_saved) {
  for (const SteeringLaw& law : {SteeringLaw(PurePursuit{}), SteeringLaw(Stanley{}), SteeringLaw(Preview{})}) {
    const DriverSpec spec = everything(law);
    const auto driver = make_driver(spec, test_car());
    Bicycle bicycle;
    std::vector<Archive> saved, records;
    std::vector<Bicycle> places;
    bool full = false, braked = false, held = false, turning = false;
    double steering = 0.0;
    for (int i = 0; i < kSteps; ++i) {
      Archive& state = saved.emplace_back();
      driver->save(state);
      places.push_back(bicycle);
      const DriverInputs inputs = driver->drive(bicycle.view(i * kStep));
      records.push_back(numbers_of(driver->record()));
      full |= inputs.throttle == 1.0;
      braked |= inputs.brake > 0.0 && inputs.brake < 1.0;
      held |= i > 100 && bicycle.speed == 0.0 && inputs.brake == 1.0;
      turning |= std::abs(std::abs(inputs.steering - steering) - 0.4 * kStep) < 1e-12;
      steering = inputs.steering;
      move(bicycle, inputs);
    }
    // The drive contained full throttle, braking, holding and turning.
    EXPECT_TRUE(full && braked && held && turning) << full << braked << held << turning;
    EXPECT_TRUE(driver->record().path_ended);
    for (int start = 0; start < kSteps; start += 37) {
      const auto restored = make_driver(spec, test_car());
      restored->restore(saved[static_cast<std::size_t>(start)]);
      if (start > 0) {
        ASSERT_EQ(numbers_of(restored->record()).arrays(), records[static_cast<std::size_t>(start) - 1].arrays());
      }
      Bicycle copy = places[static_cast<std::size_t>(start)];
      for (int i = start; i < std::min(start + 100, kSteps); ++i) {
        const DriverInputs inputs = restored->drive(copy.view(i * kStep));
        ASSERT_EQ(numbers_of(restored->record()).arrays(), records[static_cast<std::size_t>(i)].arrays())
            << "saved before step " << start << ", differs in step " << i;
        move(copy, inputs);
      }
    }
  }
}

TEST(Driver, lists_of_fields_forget_no_member) {
  const auto complete = []<class T>(const T&) {
    EXPECT_EQ(names_of<T>().size(), member_count<T>()) << names_of<T>().front();
  };
  complete(DriverInputs{});
  complete(DriverCar{});
  complete(DriverRecord{});
  complete(SpeedState{});
  complete(PathState{});
  complete(PathPlace{});
  complete(InputSpec{});
  complete(SpeedSpec{});
}

TEST(DriverView, speed_is_along_the_heading) {
  DriverView view;
  view.yaw = 2.0;
  view.velocity = Vec3(3.0 * std::cos(2.0) - std::sin(2.0), 3.0 * std::sin(2.0) + std::cos(2.0), 7.0);
  EXPECT_NEAR(view.speed(), 3.0, 1e-15);
}
