#include "rigs/rolling_tire.hpp"

#include <algorithm>

#include "protocol/core/constants.hpp"
#include "protocol/core/error.hpp"
#include "terrain/rigid/rigid_ground.hpp"
#include "tire/reach.hpp"

namespace furrow::rigs {
namespace {

constexpr double kGap = 1e-3;         // m, between ground and undeformed tire at the start
constexpr double kGroundStep = 4e-5;  // s, largest step at which the default ground is stable under a tread vertex
constexpr double kFriction = 0.9, kVelocityScale = 50.0;  // -, s/m: the ground of rigs/rigid_ground.json

}  // namespace

terrain::GroundOptions hard_ground(double step) {
  terrain::GroundOptions options;
  const double slower = std::max(1.0, step / kGroundStep);
  options.ground_stiffness /= slower * slower;
  options.ground_shear_stiffness /= slower * slower;
  options.ground_damping /= slower;
  return options;
}

RollingTire::RollingTire(tire::Tire& tire, const RollingOptions& options) : tire_(tire), options_(options) {
  terrain::GroundOptions ground = hard_ground(options.step);
  ground.friction = kFriction;
  ground.friction_velocity_scale = kVelocityScale;
  ground_ = terrain::make_rigid_ground(ground);
  rim_.position = Vec3(0.0, 0.0, tire::inflated_reach(tire, 0.0) + kGap);
  rim_.velocity = Vec3(options.spin * tire.radius(), 0.0, 0.0);
  rim_.angular_velocity = Vec3(0.0, options.spin, 0.0);
  trajectory_ = tire::RimTrajectory(rim_);
  tire.place(rim_);
  tire.surface(surface_);
  ground_->attach(tire.mesh(), tire.material(), surface_);
}

void RollingTire::push() {
  acting_ = forces_;
  const Outcome pushed = ground_->advance({&surface_, 1}, options_.step, 1, {&forces_, 1}, {&contact_, 1});
  if (!pushed.ok) throw physics_error(pushed, "ground");
  trajectory_.extend(rim_, options_.step);
}

void RollingTire::roll() {
  const Outcome moved = tire_.advance(trajectory_, acting_, 1);
  tire_.surface(surface_);
  if (!moved.ok) throw physics_error(moved, "tire");
}

void RollingTire::follow(double damper) {
  const double h = options_.step;
  const Vec3 before = wrench_.force;  // the carriage receives the force one step late
  wrench_ = tire_.spindle_wrench();
  rim_.velocity.x() += h * before.x() / options_.load;
  rim_.velocity.z() += h * ((before.z() - damper * rim_.velocity.z()) / options_.load - kStandardGravity);
  rim_.position += h * rim_.velocity;
  rim_.orientation = (Quat(Eigen::AngleAxisd(h * options_.spin, Vec3::UnitY())) * rim_.orientation).normalized();
}

}  // namespace furrow::rigs
