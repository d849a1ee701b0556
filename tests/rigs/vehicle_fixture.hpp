// Vehicle rigs on simple tires: a linear spring and damper upward, and a force along the ground that follows the slip.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "protocol/core/error.hpp"
#include "protocol/files/data_files.hpp"
#include "rigs/vehicle/vehicle_rig.hpp"
#include "tests/rigs/rig_probe.hpp"
#include "vehicle/driver/read_driver.hpp"
#include "vehicle/spec/read_vehicle.hpp"

namespace furrow::testing {

inline vehicle::VehicleSpec shipped_vehicle(const std::string& name) {
  return vehicle::read_vehicle(data_folder() / "vehicle" / "data" / name);
}

/// A plan in which the vehicle is lowered at 0.39 m/s for 0.35 s, or as in `lowering`. @param driver as in a driver's
/// file, null: parked
inline rigs::VehicleRigPlan vehicle_plan(const std::string& file, nlohmann::json driver = nullptr,
                                         double lowering = 0.39) {
  rigs::VehicleRigPlan plan;
  plan.vehicle = shipped_vehicle(file);
  plan.options.lowering_speed = lowering;
  plan.options.touchdown_time = 0.35;
  plan.tire_width = 0.3;
  if (driver.is_null()) return plan;
  driver["format_version"] = 1;
  plan.driver = vehicle::read_driver(driver, "driver");
  return plan;
}

/// A vehicle of the HMMWV's size on its ground z = 0.
struct Track {
  double radius = 0.4673;   // m
  double stiffness = 4e5;   // N/m
  double damping = 4e3;     // N s/m
  double friction = 0.9;    // -
  double slip_scale = 2.0;  // s/m, of the force with the sliding speed: it comes one step late
  double step = 5e-4;       // s
  bool sinks = false;       // observes the depth of the tires
  MassProperties tire{4.8, Vec3(0.5, 0.78, 0.5).asDiagonal().toDenseMatrix()};

  std::unique_ptr<rigs::Rig> rig(const rigs::VehicleRigPlan& plan, double gap = 0.0) const {
    auto rig = rigs::make_vehicle_rig(plan);
    add_tires(*rig);
    rig->place(std::vector<double>(rig->wheel_count(), radius + gap));
    return rig;
  }
  void add_tires(rigs::Rig& rig) const {
    for (int k = 0; k < rig.wheel_count(); ++k) rig.add_tire_mass(k, tire, radius);
  }

  Wrench wrench(const RimState& rim) const {
    const Vec3 arm(0.0, 0.0, -rim.position.z());
    const Vec3 sliding = rim.velocity + rim.angular_velocity.cross(arm);
    const double depth = radius - rim.position.z();
    const double load = depth > 0.0 ? std::max(0.0, stiffness * depth - damping * rim.velocity.z()) : 0.0;
    Wrench on_rim;
    on_rim.force = Vec3(-friction * load * std::tanh(slip_scale * sliding.x()),
                        -friction * load * std::tanh(slip_scale * sliding.y()), load);
    on_rim.moment = arm.cross(on_rim.force);
    return on_rim;
  }

  /// @param after called after every advance
  void drive(rigs::Rig& rig, double duration, const std::function<void()>& after = {}, int substeps = 1) const {
    const auto steps = static_cast<int>(std::lround(duration / step));
    std::vector<Wrench> wrenches(rig.wheel_count());
    for (int i = 0; i < steps; ++i) {
      for (int k = 0; k < rig.wheel_count(); ++k) wrenches[k] = wrench(rig.rim(k));
      const Outcome outcome = rig.advance(wrenches, step, substeps);
      if (!outcome.ok) throw physics_error(outcome, "rig");
      for (int k = 0; sinks && k < rig.wheel_count(); ++k) rig.observe(k, rig.rim(k).position.z() - radius, 0.0);
      if (after) after();
    }
  }
};

inline double of_vehicle(const rigs::Rig& rig, std::string_view column) {
  return measured(rig, rig.wheel_count(), column);
}

}  // namespace furrow::testing
