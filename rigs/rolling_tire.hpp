// A driven tire under a carriage on the plane z = 0, coupled like the ranks, for benchmarks.
//
// The wheel turns at constant speed. The carriage m is free along x and z, so that the wheel rolls without pull:
//   m v' = F_spindle − (0, 0, m g) − (0, 0, c v_z).
// The ground's forces act one step late, and so does the spindle's force on the carriage.
#pragma once

#include <memory>

#include "terrain/rigid/ground_options.hpp"
#include "terrain/terrain.hpp"
#include "tire/rim_trajectory.hpp"
#include "tire/tire.hpp"

namespace furrow::rigs {

/// Returns a rigid plane that is softer for steps above 4e-5 s, the largest step at which the default plane is stable
/// under a tread vertex. The reason is that its forces act one step late (terrain/rigid/rigid_ground.hpp).
terrain::GroundOptions hard_ground(double step);

struct RollingOptions {
  double load = 465.0;  // m, carried by the spindle, kg
  double spin = 8.56;   // of the rim, rad/s
  double step = 4e-5;   // s
};

class RollingTire {
 public:
  /// Places the tire 1 mm above the ground, at the speed of rolling. `tire` must outlive this.
  /// @throws Error(physics) when inflation does not converge
  RollingTire(tire::Tire& tire, const RollingOptions& options);

  // One step is push(), roll() and follow(), in this order.
  /// Computes the ground's forces on the tire in its present position. @throws Error(physics)
  void push();
  /// Advances the tire by one step; a function of its own so that it can be timed. @throws Error(physics)
  void roll();
  /// Advances the carriage by one step, with a vertical damper c, N s/m.
  void follow(double damper);

  const Wrench& wrench() const { return wrench_; }     // of the tire on the rim, mean of the last step
  double height() const { return rim_.position.z(); }  // of the axle, m

 private:
  tire::Tire& tire_;
  RollingOptions options_;
  std::unique_ptr<terrain::Terrain> ground_;
  RimState rim_;
  tire::RimTrajectory trajectory_;
  SurfaceState surface_;
  NodalForces acting_, forces_;  // on the tire in this step; the ground's answer, for the next one
  ContactSums contact_;
  Wrench wrench_;
};

}  // namespace furrow::rigs
