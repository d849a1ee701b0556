// Steering along paths, by a kinematic bicycle, against closed forms.
#include "vehicle/driver/path_follower.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/vehicle/driver/bicycle.hpp"
#include "vehicle/driver/file_driver.hpp"
#include "vehicle/driver/lane_change.hpp"

using namespace furrow;
using namespace furrow::testing;
using namespace furrow::vehicle;

namespace {

constexpr double kAtOnce = 1e6;  // rate of steering, practically unlimited, 1/s

DriverSpec along(const PathShape& shape, const SteeringLaw& law, double rate = kAtOnce) {
  DriverSpec spec;
  spec.path.emplace();
  spec.path->shape = shape;
  spec.path->steering = {law, rate};
  return spec;
}

PurePursuit look(double distance) { return {0.0, distance}; }

}  // namespace

// Small errors e over the distance s: ë + (2/D) ė + (2/D²) e = 0, from e₀ along the path.
TEST(PurePursuit, comes_back_to_a_straight_by_its_linear_equation) {
  const double ahead = 6.0, speed = 6.0, dt = 1e-4, start = 0.01;
  const auto driver = make_driver(along(StraightPath{100.0}, look(ahead)), test_car());
  Bicycle bicycle{0.0, start, 0.0, speed};
  follow(*driver, bicycle, 50000, dt, [&](double time) {
    const double s = speed * time / ahead;
    ASSERT_NEAR(driver->record().cross_track, start * std::exp(-s) * (std::cos(s) + std::sin(s)), 1e-3 * start) << s;
  });
}

// A vehicle that turns with the share g of the commanded curvature drives a circle with R'² = R² + D² (1/g − 1).
TEST(PurePursuit, steady_circle_has_the_radius_of_its_triangle) {
  for (const double response : {1.0, 0.8, 1.1}) {
    for (const char* turn : {"left", "right"}) {
      const double radius = 20.0, ahead = 5.0, side = std::string(turn) == "left" ? 1.0 : -1.0;
      const auto driver = make_driver(along(CirclePath{0.0, radius, 1080.0, turn}, look(ahead)), test_car());
      Bicycle bicycle{0.0, 0.0, 0.0, 10.0};
      follow(
          *driver, bicycle, 30000, 1e-3, [](double) {}, response);
      const double expected = std::sqrt(radius * radius + ahead * ahead * (1.0 / response - 1.0));
      EXPECT_NEAR(std::hypot(bicycle.x, bicycle.y - side * radius), expected, 1e-6) << response << turn;
      EXPECT_NEAR(driver->record().cross_track, side * (radius - expected), 1e-6);
      EXPECT_NEAR(driver->record().heading_error, 0.0, 1e-6);
    }
  }
}

// Small errors on a curve y(s): ë + (2/D) ė + (2/D²) e = (2/D²) Σ Dⁿ/n! y⁽ⁿ⁾ from n = 3, so after the start has
// decayed, e = D³/6 y‴ − D⁴/8 y⁗ + D⁵/20 y⁽⁵⁾. In the middle of a smoothstep of height h and length T these are −30
// h/T³, 0 and 720 h/T⁵; the slope c = 15/8 h/T makes the first one smaller by (1 + c²)², as curvature counts by the
// length of the path.
TEST(PurePursuit, error_in_a_lane_change_is_that_of_the_cut_corner) {
  const auto lanes = lanes_of("iso_3888_1", test_car().width);
  const double height = lanes[2].centre - lanes[1].centre, length = lanes[2].start - lanes[1].end;
  const double middle = 10.0 + 0.5 * (lanes[2].start + lanes[1].end), slope = 15.0 / 8.0 * height / length;
  for (const double ahead : {1.0, 1.4}) {
    const auto driver = make_driver(along(LaneChangePath{"iso_3888_1", 10.0, 10.0}, look(ahead)), test_car());
    Bicycle bicycle{0.0, 0.0, 0.0, 5.0};
    double in_middle = 0.0, largest = 0.0;
    follow(*driver, bicycle, 27500, 1e-3, [&](double) {
      largest = std::max(largest, std::abs(driver->record().cross_track));
      if (bicycle.x < middle) in_middle = driver->record().cross_track;
    });
    const double third = -30.0 * height / std::pow(length, 3), fifth = 720.0 * height / std::pow(length, 5);
    const double expected =
        std::pow(ahead, 3) / 6.0 * third / std::pow(1.0 + slope * slope, 2) + std::pow(ahead, 5) / 20.0 * fifth;
    EXPECT_NEAR(in_middle / expected, 1.0, 0.02) << ahead;
    EXPECT_LT(largest, std::pow(ahead, 3) / 6.0 * 2.0 * std::abs(third)) << ahead;
    EXPECT_GT(driver->record().path_distance, 130.0);
  }
}

// The front axle moves along −arctan w with w = k e/(k_s + v): small errors decay with k v/(k_s + v).
TEST(Stanley, error_of_the_front_axle_decays_exponentially) {
  const double speed = 10.0, dt = 1e-4, start = 0.02;
  const Stanley law{1.5, 1.0};
  const auto driver = make_driver(along(StraightPath{200.0}, law), test_car());
  Bicycle bicycle{0.0, start, 0.0, speed};
  follow(*driver, bicycle, 40000, dt, [&](double time) {
    const double rate = law.gain * speed / (law.soft_speed + speed);
    ASSERT_NEAR(driver->record().cross_track, start * std::exp(-rate * time), 1e-3 * start) << time;
  });
}

// With the front axle on the circle of radius R the rear axle runs on √(R² − L²), and the yaw lags by asin L/R.
TEST(Stanley, keeps_the_front_axle_on_a_circle) {
  const double radius = 20.0, wheelbase = test_car().wheelbase;
  for (const char* turn : {"left", "right"}) {
    const double side = std::string(turn) == "left" ? 1.0 : -1.0;
    const auto driver = make_driver(along(CirclePath{10.0, radius, 1080.0, turn}, Stanley{}), test_car());
    Bicycle bicycle{0.0, 0.0, 0.0, 10.0};
    follow(*driver, bicycle, 30000, 1e-3, [](double) {});
    EXPECT_NEAR(driver->record().cross_track, 0.0, 1e-6) << turn;
    EXPECT_NEAR(driver->record().heading_error, -side * std::asin(wheelbase / radius), 1e-6);
    EXPECT_NEAR(std::hypot(bicycle.x - 10.0, bicycle.y - side * radius),
                std::sqrt(radius * radius - wheelbase * wheelbase), 1e-6);
  }
}

// Critically damped in the distance d: e = e₀ (1 + s/d) e^(−s/d), from e₀ along the path.
TEST(Preview, comes_back_to_a_straight_critically_damped) {
  const double d = 5.0, speed = 6.0, dt = 1e-4, start = 0.01;
  const auto driver = make_driver(along(StraightPath{100.0}, Preview{0.2, 0.0, d, 0.0, 0.0, 0.0}), test_car());
  Bicycle bicycle{0.0, start, 0.0, speed};
  follow(*driver, bicycle, 50000, dt, [&](double time) {
    const double s = speed * time / d;
    ASSERT_NEAR(driver->record().cross_track, start * (1.0 + s) * std::exp(-s), 1e-3 * start) << s;
  });
}

// A vehicle that turns by δ − K v² κ stays on a circle if its driver is given K; otherwise it is (δ_K/L) d² off.
TEST(Preview, keeps_an_understeering_vehicle_on_a_circle) {
  const double radius = 40.0, speed = 10.0, gradient = 0.01, d = 5.0;
  const DriverCar car = test_car();
  for (const bool known : {true, false}) {
    const auto driver = make_driver(
        along(CirclePath{0.0, radius, 1080.0, "left"}, Preview{0.2, 0.0, d, known ? gradient : 0.0, 0.0, 0.0}), car);
    Bicycle bicycle{0.0, 0.0, 0.0, speed};
    double curvature = 0.0;
    for (int i = 0; i < 40000; ++i) {
      const double angle = driver->drive(bicycle.view(1e-3 * i)).steering * car.steering_lock;
      for (int k = 0; k < 20; ++k) curvature = std::tan(angle - gradient * speed * speed * curvature) / car.wheelbase;
      bicycle.roll(curvature, 1e-3);
    }
    const double missing = known ? 0.0 : gradient * speed * speed / radius / car.wheelbase;
    EXPECT_NEAR(driver->record().cross_track, -missing * d * d, 0.02 * missing * d * d + 2e-3) << known;
  }
}

// A driver without look-ahead uses the path's curvature at the axle, so no corner is cut.
TEST(Preview, stays_on_a_lane_change) {
  const auto driver = make_driver(
      along(LaneChangePath{"iso_3888_1", 10.0, 10.0}, Preview{0.0, 0.6, -1.0, 0.0, 0.0, 0.0}, 1.0), test_car());
  Bicycle bicycle{0.0, 0.0, 0.0, 12.0};
  double largest = 0.0;
  follow(*driver, bicycle, 11500, 1e-3,
         [&](double) { largest = std::max(largest, std::abs(driver->record().cross_track)); });
  EXPECT_LT(largest, 0.03);
  EXPECT_GT(driver->record().path_distance, 130.0);
}

TEST(PathFollower, default_laws_stay_within_a_lane_change_at_36_km_h) {
  for (const SteeringLaw& law :
       {SteeringLaw(PurePursuit{}), SteeringLaw(Stanley{}), SteeringLaw(Preview{0.0, 0.6, -1.0, 0.0, 0.0, 0.0})}) {
    const auto driver = make_driver(along(LaneChangePath{"iso_3888_1", 20.0, 20.0}, law, 1.0), test_car());
    Bicycle bicycle{0.0, 0.0, 0.0, 10.0};
    double largest = 0.0;
    follow(*driver, bicycle, 1450, 1e-2,
           [&](double) { largest = std::max(largest, std::abs(driver->record().cross_track)); });
    EXPECT_LT(largest, 0.6) << law.index();
    EXPECT_NEAR(bicycle.y, lanes_of("iso_3888_1", test_car().width)[2].centre, 0.05) << law.index();
  }
}

TEST(PathFollower, comes_back_from_far_beside_the_path_behind_its_start_and_beyond_its_end) {
  for (const SteeringLaw& law :
       {SteeringLaw(PurePursuit{}), SteeringLaw(Stanley{}), SteeringLaw(Preview{0.0, 0.6, -1.0, 0.0, 0.0, 0.0})}) {
    for (const double side : {-15.0, 15.0}) {
      const auto driver = make_driver(along(StraightPath{30.0}, law, 1.0), test_car());
      Bicycle bicycle{-20.0, side, 0.0, 5.0};
      follow(*driver, bicycle, 30000, 1e-3, [](double) {});
      EXPECT_NEAR(bicycle.y, 0.0, 1e-3) << law.index();
      EXPECT_GT(bicycle.x, 50.0);
      EXPECT_NEAR(bicycle.yaw, 0.0, 1e-3);
      EXPECT_TRUE(driver->record().path_ended);
    }
  }
}

TEST(PathFollower, turns_the_wheel_no_faster_than_it_may) {
  const auto driver = make_driver(along(CirclePath{0.0, 10.0, 360.0, "left"}, look(5.0), 0.5), test_car());
  Bicycle bicycle{0.0, 3.0, 0.0, 5.0};
  double before = 0.0, fastest = 0.0;
  follow(*driver, bicycle, 3000, 1e-3, [&](double) {
    const double steering = driver->record().inputs.steering;
    fastest = std::max(fastest, std::abs(steering - before) / 1e-3);
    before = steering;
  });
  EXPECT_NEAR(fastest, 0.5, 1e-9);
}

TEST(PathFollower, end_of_the_path_is_noticed_once) {
  const auto driver = make_driver(along(StraightPath{10.0}, look(5.0)), test_car());
  Bicycle bicycle{0.0, 0.0, 0.0, 5.0};
  follow(*driver, bicycle, 3000, 1e-3, [&](double time) {
    if (time < 1.9995) {
      ASSERT_FALSE(driver->record().path_ended) << time;
    } else if (time > 2.0015) {
      ASSERT_TRUE(driver->record().path_ended) << time;
      ASSERT_NEAR(driver->record().path_end_time, 2.0, 1.5e-3);
    }
  });
}

TEST(PathFollower, place_never_goes_back_nor_jumps_where_the_path_crosses_itself) {
  WaypointPath eight;
  for (int i = 0; i <= 40; ++i) {
    const double a = 2.0 * std::numbers::pi * i / 40.0;
    eight.points.emplace_back(30.0 * std::sin(a), 15.0 * std::sin(2.0 * a));
  }
  const auto driver = make_driver(along(eight, look(4.0)), test_car());
  Bicycle bicycle{0.0, 0.0, std::numbers::pi / 4.0, 5.0};
  double before = 0.0;
  follow(*driver, bicycle, 30000, 1e-3, [&](double) {
    const double distance = driver->record().path_distance;
    ASSERT_GE(distance, before);
    ASSERT_LT(distance - before, 0.02);
    ASSERT_LT(std::abs(driver->record().cross_track), 0.5);
    before = distance;
  });
  EXPECT_GT(before, 140.0);
  driver->drive(bicycle.view(30.0));
  before = driver->record().path_distance;
  bicycle.speed = -5.0;
  for (int i = 30001; i < 31000; ++i) {
    driver->drive(bicycle.view(i * 1e-3));
    bicycle.roll(0.0, 1e-3);
  }
  EXPECT_EQ(driver->record().path_distance, before);
}
