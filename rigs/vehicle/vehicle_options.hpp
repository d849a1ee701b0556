// Scenario keys of a rig of type `vehicle`, and the parts from which the rig is made.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "protocol/core/constants.hpp"
#include "protocol/core/fields.hpp"
#include "protocol/core/key.hpp"
#include "rigs/rig_keys.hpp"
#include "vehicle/driver/driver_spec.hpp"
#include "vehicle/spec/vehicle_spec.hpp"

namespace furrow::rigs {

/// Every field is the scenario key `rig.<name>`.
struct VehicleRigOptions {
  std::string vehicle;             // a vehicle's file
  nlohmann::json driver;           // a driver's file, or its content; null: no driver, the brakes hold
  double start = 0.0;              // x of the vehicle's origin at t = 0, m; filled in if the scenario does not give it
  double lateral = 0.0;            // y of the vehicle's origin at t = 0, m
  double heading = 0.0;            // of the vehicle's x axis at t = 0, about +z from the world's, rad
  double slope = 0.0;              // of the ground, which rises along +x, rad
  double start_speed = 0.0;        // at t = 0, forward, m/s
  double lowering_speed = -1.0;    // at which the vehicle is lowered, m/s; negative: open
  double touchdown_time = -1.0;    // how long the damper of the lowering acts, s; negative: open
  double stop_before_wall = -1.0;  // between a tire and the end wall, at which the run ends, m; negative: open
};
void visit_fields(FieldsOf<VehicleRigOptions> auto& s, auto&& visit) {
  using namespace allowed;
  visit(s.vehicle,
        key("vehicle", "", not_empty().or_null(),
            "Vehicle file, relative to the scenario, then to the folders rigs/ and vehicle/data/. Its wheels name "
            "their tires; `tire` changes all of them, `tires` those of each wheel or each axle."));
  visit(s.driver,
        key("driver", "", shaped(R"({"type": ["string", "object"]})").not_empty().or_null(),
            "Driver file in JSON or CSV, found like the vehicle's file, or the content of such a file. null: nobody "
            "drives and the brakes hold."));
  visit(s.start, keys::kStart);
  visit(s.lateral, key("lateral", "m", from(-1e6, 1e6),
                       "Place along y of the origin of the vehicle's frame at t = 0. The bin's middle is y = 0."));
  visit(s.heading,
        key("heading", "rad", from(-3.15, 3.15), "Direction of the vehicle at t = 0, about +z from the x axis."));
  visit(s.slope,
        key("slope", "rad", from(-1.2, 1.2).usual(-0.7, 0.7),
            "Slope of the ground; it rises along +x if positive. Gravity is tilted and z is normal to the ground. "
            "Grains settle on level ground and are tilted then."));
  visit(s.start_speed,
        key("start_speed", "m/s", from(0, 100),
            "Speed of a vehicle at t = 0, along its heading. Its wheels roll and its driveline turns with them, in the "
            "gear that the driver asks for, or else in the lowest gear that the gearbox would keep. Without a driver "
            "its brakes are locked."));
  visit(s.lowering_speed, keys::kLoweringSpeed);
  visit(s.touchdown_time, keys::kTouchdownTime);
  visit(s.stop_before_wall,
        key("stop_before_wall", "m", from(0, 1e6).or_null(),
            "Distance at which a vehicle's run ends: between a tire and the end wall of the bin, or twice that between "
            "a tire and a side wall. 0: the run does not end there. null: radius of the largest tire."));
}

struct VehicleRigPlan {
  vehicle::VehicleSpec vehicle;
  std::optional<vehicle::DriverSpec> driver;
  VehicleRigOptions options;  // lowering_speed 0: the vehicle falls
  double tire_width = 0.0;    // of the widest tire, m
  Vec3 gravity = standard_gravity();
};

}  // namespace furrow::rigs
