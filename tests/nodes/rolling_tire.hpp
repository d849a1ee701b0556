// A flexible tire on the drawbar rig over hard ground, coupled as in the nodes, but in one thread and with access to
// all parts.
#pragma once

#include <array>
#include <memory>

#include "nodes/ranks/carried_wrench.hpp"
#include "rigs/drawbar_rig.hpp"
#include "rigs/rolling_tire.hpp"
#include "terrain/rigid/rigid_ground.hpp"
#include "tests/tire/ancf/small_tire.hpp"
#include "tire/reach.hpp"

namespace furrow::test {

/// Ground whose friction starts at lower sliding speeds than by default.
inline terrain::GroundOptions hard_ground(double step) {
  terrain::GroundOptions options = rigs::hard_ground(step);
  options.friction_velocity_scale = 200.0;
  return options;
}

class RollingTire {
 public:
  tire::AncfTire tire;
  std::unique_ptr<rigs::Rig> rig;
  std::unique_ptr<terrain::Terrain> ground;
  tire::RimTrajectory trajectory;  // of the last interval
  NodalForces on_tire;             // that acted on the tire over the last interval
  SurfaceState before, after;      // of the tire, at its ends
  ContactSums contact;             // of the ground over the last interval

  RollingTire(const tire::TireFile& file, const rigs::DrawbarRigOptions& options, double step)
      : tire(file),
        rig(rigs::make_drawbar_rig(options)),
        ground(terrain::make_rigid_ground(hard_ground(step))),
        step_(step) {
    rig->add_tire_mass(0, tire.mass_properties(), tire.radius());
    const std::array<double, 1> height{tire::inflated_reach(tire, options.camber_angle)};
    rig->place(height);
    trajectory = tire::RimTrajectory(rig->rim(0));
    tire.place(rig->rim(0));
    tire.surface(after);
    ground->attach(tire.mesh(), tire.material(), after);
  }

  /// Runs one interval. @throws Error(physics) when a part of it fails
  void step() {
    on_tire = forces_;
    before = after;
    const Wrench sent = sent_;
    const RimState rim = rig->rim(0);
    const Outcome pushed = ground->advance({&before, 1}, step_, 1, {&forces_, 1}, {&contact, 1});
    if (!pushed.ok) throw physics_error(pushed, "ground");
    trajectory.extend(rim, step_);
    const Outcome moved = tire.advance(trajectory, on_tire, 1);
    if (!moved.ok) throw physics_error(moved, "tire");
    sent_ = ranks::carried_wrench(tire.spindle_wrench(), tire.mass_properties(), trajectory.start(), trajectory.end(),
                                  step_, tire.gravity());
    tire.surface(after);
    const Outcome driven = rig->advance({&sent, 1}, step_, 1);
    if (!driven.ok) throw physics_error(driven, "rig");
  }

 private:
  double step_;
  NodalForces forces_;
  Wrench sent_;
};

}  // namespace furrow::test
