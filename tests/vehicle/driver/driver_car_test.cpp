// Drivers' data of the shipped vehicles; drivers written and read again.
#include "vehicle/driver/driver_car.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include <nlohmann/json.hpp>

#include "protocol/core/constants.hpp"
#include "protocol/files/data_files.hpp"
#include "vehicle/driver/read_driver.hpp"
#include "vehicle/driver/write_driver.hpp"
#include "vehicle/spec/read_vehicle.hpp"

using namespace furrow;
using namespace furrow::vehicle;
using nlohmann::json;

namespace {

VehicleSpec shipped(const char* name) { return read_vehicle(data_folder() / "vehicle" / "data" / name); }

}  // namespace

TEST(DriverCar, of_the_hmmwv) {
  const VehicleSpec spec = shipped("hmmwv.json");
  const DriverCar car = driver_car(spec, std::vector(4, 0.4673), 0.3, 2442.0);
  EXPECT_NEAR(car.wheelbase, 3.30193, 1e-5);
  EXPECT_NEAR(car.width, 2.12, 1e-9);
  EXPECT_GT(car.steering_lock, 0.3);  // of 30° at the Pitman arm
  EXPECT_LT(car.steering_lock, 0.7);
  // 793 N m × 2 / 0.04 is more than the grip.
  EXPECT_NEAR(car.drive_force, 0.8 * 2442.0 * kStandardGravity, 1e-6);
  EXPECT_NEAR(car.brake_force, car.drive_force, 1e-9);  // 16 kN m are 34 kN
  EXPECT_NEAR(rear_axle_middle(spec).x(), -1.652965, 1e-9);
  EXPECT_TRUE(can_steer(spec) && can_drive(spec));
}

TEST(DriverCar, of_the_rover_and_of_a_trailer) {
  VehicleSpec spec = shipped("rover.json");
  const DriverCar car = driver_car(spec, std::vector(6, 0.058), 0.05, 15.0);
  EXPECT_NEAR(car.wheelbase, 0.44, 1e-9);
  EXPECT_NEAR(car.steering_lock, std::atan(2.0 * 0.5 * 0.44 / 0.32), 1e-9);
  EXPECT_NEAR(car.drive_force, 0.8 * 15.0 * kStandardGravity, 1e-9);  // six times 3 N m are 310 N
  spec.driveline = {};
  EXPECT_FALSE(can_steer(spec) || can_drive(spec));
  EXPECT_GT(driver_car(spec, std::vector(6, 0.058), 0.05, 15.0).drive_force, 0.0);
}

TEST(DriverDocument, is_read_as_the_same_driver) {
  for (const char* text :
       {R"({"format_version": 1, "inputs": {"throttle": [[0, 0], [1, 0.5]], "gear": [[0, -1], [2, "auto"]]}})",
        R"({"format_version": 1, "inputs": {"steering": -0.3, "brake": 1}})",
        R"({"format_version": 1, "speed": {"target": 5, "proportional": 0.2},
               "path": {"kind": "double_lane_change", "track": "iso_3888_2", "lead_in": 3, "y": -1}})",
        R"({"format_version": 1, "speed": {"target": [[0, 0], [3, 4]]},
               "path": {"kind": "waypoints", "points": [[0, 0], [5, 1], [9, 3]], "steering": {"law": "stanley"}}})",
        R"({"format_version": 1, "path": {"kind": "circle", "radius": 9, "turn": "right",
               "steering": {"lookahead_distance": 2}}})"}) {
    const json document = driver_document(read_driver(json::parse(text), "test"));
    EXPECT_EQ(driver_document(read_driver(document, "test")), document) << text;
    const json given = json::parse(text);
    for (const auto& [section, values] : given.items()) {
      if (!values.is_object()) continue;
      for (const auto& [key, value] : values.items()) {
        const json& now = document[section][key];
        if (!value.is_object() && !(value.is_number() && now.is_array())) {
          EXPECT_EQ(now, value) << section << "." << key;
        }
      }
    }
  }
}
