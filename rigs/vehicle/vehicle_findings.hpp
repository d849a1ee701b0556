// What a vehicle's run reports besides its tables: wheels that lose the ground, how near it keeps to its path, changes
// of gear. Nothing that moves depends on it.
//
// A wheel is lifted while it carries less than 1 % of its load at rest, until it carries 5 % again, for at least 10 ms,
// and after it has once carried half of it. Path errors are those of the axle that the law looks at. The margin in the
// lanes of a lane change is what is left between their limits and the rectangle of the vehicle's width from axle to
// axle.
#pragma once

#include <optional>
#include <vector>

#include "protocol/core/archive.hpp"
#include "rigs/rig.hpp"
#include "vehicle/driver/driver.hpp"
#include "vehicle/driver/driver_spec.hpp"

namespace furrow::rigs {

class VehicleFindings {
 public:
  /// @param loads of the wheels at rest, N
  VehicleFindings(std::vector<double> loads, const std::optional<vehicle::DriverSpec>& driver,
                  const vehicle::DriverCar& car);

  /// Wheel k carries this much, N, from this time on, s.
  void wheel(int k, double force, double time);
  void path(const vehicle::DriverView& view, const vehicle::DriverRecord& record);
  void gear(int gear);

  RigFindings told() const;
  void save(Archive& archive) const;
  void restore(const Archive& archive);

 private:
  struct Wheel {
    bool touched = false, lifted = false;
    double since = 0.0;  // when it was lifted, s
  };
  struct PathErrors {
    double count = 0.0, squares = 0.0;  // of calls; Σ e², m²
    double largest = 0.0, largest_at = 0.0;
    double margin = 0.0, margin_at = 0.0;  // the least, in lanes
    double lanes = 0.0;                    // 1: it was in one
  };

  std::vector<double> loads_;
  std::optional<vehicle::PathSpec> path_;
  double wheelbase_, width_;
  std::vector<Wheel> wheels_;
  std::vector<RigEvent> lifts_;
  PathErrors errors_;
  int gear_ = 0, changes_ = 0;
  bool geared_ = false;
};

}  // namespace furrow::rigs
