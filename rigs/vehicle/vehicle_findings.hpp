// Findings of a vehicle's run besides its tables: lifted wheels, distances from the path, changes of gear. Nothing that
// moves depends on them.
//
// A wheel is lifted from when it carries less than 1 % of its load at rest until it carries 5 % again. This counts if
// it lasts at least 10 ms and the wheel has once carried half of its load. Path errors are those of the axle that the
// driver's law follows. The margin of a lane change is the distance between the lane's limits and the rectangle of the
// vehicle's width from axle to axle.
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

  /// Records that wheel k carries `force`, N, from `time`, s, on.
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
    double count = 0.0, squares = 0.0;  // number of calls; Σ e², m²
    double largest = 0.0, largest_at = 0.0;
    double margin = 0.0, margin_at = 0.0;  // the least within lanes
    double lanes = 0.0;                    // 1: the vehicle was in a lane
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
