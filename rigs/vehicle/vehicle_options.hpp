// What a scenario says of a rig of type `vehicle`, and what its rig is made of.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "protocol/core/constants.hpp"
#include "protocol/core/fields.hpp"
#include "vehicle/driver/driver_spec.hpp"
#include "vehicle/spec/vehicle_spec.hpp"

namespace furrow::rigs {

/// Every field is the scenario key `rig.<name>`.
struct VehicleRigOptions {
  std::string vehicle;    // a vehicle's file
  nlohmann::json driver;  // a driver's file, or what is in one; null: nobody drives, the brakes hold
  double start = 0.0;     // x of the vehicle's origin at t = 0, m; where the scenario does not say it, it is filled in
  double lateral = 0.0;   // y of the vehicle's origin at t = 0, m
  double heading = 0.0;   // of the vehicle's x axis at t = 0, about +z from the world's, rad
  double slope = 0.0;     // of the ground, which rises along +x, rad
  double start_speed = 0.0;      // at t = 0, forward, m/s
  double lowering_speed = -1.0;  // at which the vehicle is let down, m/s; negative: open
  double touchdown_time = -1.0;  // how long the damper of the lowering acts, s; negative: open
  double stop_before_wall =
      -1.0;  // left between a tire and the end wall when the run ends before it, m; negative: open
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<VehicleRigOptions> auto& s) {
  visit(Field{"vehicle", "", role::key}, s.vehicle);
  visit(Field{"driver", "", role::key}, s.driver);
  visit(Field{"start", "m", role::key}, s.start);
  visit(Field{"lateral", "m", role::key}, s.lateral);
  visit(Field{"heading", "rad", role::key}, s.heading);
  visit(Field{"slope", "rad", role::key}, s.slope);
  visit(Field{"start_speed", "m/s", role::key}, s.start_speed);
  visit(Field{"lowering_speed", "m/s", role::key}, s.lowering_speed);
  visit(Field{"touchdown_time", "s", role::key}, s.touchdown_time);
  visit(Field{"stop_before_wall", "m", role::key}, s.stop_before_wall);
}

/// Everything that the rig needs.
struct VehicleRigPlan {
  vehicle::VehicleSpec vehicle;
  std::optional<vehicle::DriverSpec> driver;
  VehicleRigOptions options;  // lowering_speed 0: the vehicle falls
  double tire_width = 0.0;    // of the widest tire, m
  Vec3 gravity = standard_gravity();
};

}  // namespace furrow::rigs
