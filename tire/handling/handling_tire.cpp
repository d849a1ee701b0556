#include "tire/handling/handling_tire.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <Eigen/Cholesky>

#include "protocol/core/archive_fields.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "protocol/core/mean_turn.hpp"

namespace furrow::tire::handling {
namespace {

constexpr double kNear = 4e-3;  // ε of the weights, of the radius

/// A rim that goes on as it does.
RimState later(const RimState& rim, double duration) {
  RimState out = rim;
  out.position += duration * rim.velocity;
  const Vec3 turn = duration * rim.angular_velocity;
  const double angle = turn.norm();
  if (angle > 0.0) out.orientation = Quat(Eigen::AngleAxisd(angle, turn / angle)) * rim.orientation;
  out.orientation.normalize();
  return out;
}

}  // namespace

HandlingTire::HandlingTire(MagicFormula formula, TireShape shape, const Vec3& gravity, std::string file,
                           GroundHeights heights)
    : Tire(gravity, std::move(shape)), formula_(std::move(formula)), file_(std::move(file)), body_(shape_, gravity) {
  FURROW_ASSERT(shape_.radius == formula_.dimension.unloaded_radius, shape_.radius);
  if (heights) road_ = RoadPlane(std::move(heights), 0.5 * contact_length(formula_), 0.5 * formula_.dimension.width);
  stated_.given = true;
}

void HandlingTire::do_place(const RimState& rim) {
  body_.place(rim);
  rim_ = met_ = rim;
  spindle_ = {};
  patch_ = {};
  standing_ = true;
  dissipation_ = 0.0;
  stated_.forces.clear();
  stated_.friction.clear();
}

bool HandlingTire::on_ground(const ContactMotion& motion) const {
  return !standing_ && motion.deflection > 0.0 &&
         motion.deflection < formula_.dimension.unloaded_radius - formula_.dimension.rim_radius;
}

void HandlingTire::move(const RimState& rim, std::vector<Vec3>& position, std::vector<Vec3>* velocity) const {
  const std::size_t count = shape_.vertex.size();
  position.resize(count);
  if (velocity) velocity->resize(count);
  const Mat3 turn = rim.orientation.toRotationMatrix();
  const ContactMotion motion = motion_of(rim);
  const Vec3& up = motion.axes.z;
  const bool flat = on_ground(motion);
  for (std::size_t k = 0; k < count; ++k) {
    const Vec3 arm = turn * shape_.vertex[k];
    position[k] = rim.position + arm;
    if (velocity) (*velocity)[k] = rim.velocity + rim.angular_velocity.cross(arm);
    const double height = motion.axes.height(position[k]);
    if (!flat || height >= 0.0) continue;
    position[k] -= height * up;
    if (velocity) (*velocity)[k] -= (*velocity)[k].dot(up) * up;
  }
}

Outcome HandlingTire::do_advance(const RimTrajectory& rim, const NodalForces& forces, int) {
  const Outcome moved = body_.advance(rim, {}, 1);
  if (!moved.ok) return moved;
  spindle_ = body_.spindle_wrench();
  move(rim.start(), before_, nullptr);
  move(rim.end(), after_, nullptr);
  const Vec3 centre = 0.5 * (rim.start().position + rim.end().position);
  for (std::size_t i = 0; i < forces.vertex.size(); ++i) {
    const int k = forces.vertex[i];
    spindle_.force += forces.force[i];
    spindle_.moment += (0.5 * (before_[k] + after_[k]) - centre).cross(forces.force[i]);
  }
  rim_ = rim.end();
  return {};
}

Outcome HandlingTire::state_contact(const RimState& now, double duration) {
  if (!standing_) {
    RimState middle = later(met_, 0.5 * duration);
    middle.velocity = 0.5 * (met_.velocity + now.velocity);
    middle.angular_velocity = 0.5 * (met_.angular_velocity + now.angular_velocity);
    patch_ = advanced(formula_, motion_of(middle), patch_, duration);
  }
  standing_ = false;
  met_ = now;
  stated_.forces.clear();
  stated_.friction.clear();
  const double pressed = motion_of(now).deflection,
               most = formula_.dimension.unloaded_radius - formula_.dimension.rim_radius;
  if (pressed >= most)
    return Outcome::failure(
        fmt::format("is pressed by {:.4g} m, down to its rim", pressed),
        fmt::format("{}: [DIMENSION] RIM_RADIUS leaves {:.4g} m; expected less load or drop", file_, most));

  const RimState rim = later(now, 0.5 * duration);
  const ContactMotion motion = motion_of(rim);
  if (!on_ground(motion) || !(motion.load > 0.0)) return {};
  const HandlingForces f = contact_forces(formula_, motion, advanced(formula_, motion, patch_, 0.5 * duration));
  const WheelAxes& axes = motion.axes;
  const Wrench wanted{f.fx * axes.x + f.fy * axes.y + f.fz * axes.z, f.mx * axes.x + f.my * axes.y + f.mz * axes.z};
  move(rim, before_, &moving_);
  distribute(wanted, axes);
  double power = -spring_force(formula_, motion.deflection) * motion.rate;
  for (std::size_t i = 0; i < stated_.forces.vertex.size(); ++i) {
    const int k = stated_.forces.vertex[i];
    const Vec3 carried = rim.velocity + rim.angular_velocity.cross(before_[k] - rim.position);
    power += stated_.forces.force[i].dot(moving_[k] - carried);
  }
  dissipation_ += power * duration;
  return {};
}

void HandlingTire::distribute(const Wrench& wanted, const WheelAxes& axes) {
  const double reach = kNear * shape_.radius;
  double sum = 0.0;
  Vec3 mean = Vec3::Zero();
  const auto weight = [&](const Vec3& x) {
    const double height = std::max(0.0, reach - axes.height(x));
    return height * height;
  };
  const int vertices = static_cast<int>(shape_.vertex.size()) - 2;  // without the middles of the discs
  for (int k = 0; k < vertices; ++k) {
    const double w = weight(before_[k]);
    if (!(w > 0.0)) continue;
    sum += w;
    mean += w * before_[k];
  }
  FURROW_ASSERT(sum > 0.0, reach);
  mean /= sum;
  Mat3 spread = Mat3::Zero();
  for (int k = 0; k < vertices; ++k) {
    const double w = weight(before_[k]);
    if (!(w > 0.0)) continue;
    const Vec3 d = before_[k] - mean;
    spread += w * (d.squaredNorm() * Mat3::Identity() - d * d.transpose());
  }
  const Vec3 turn = spread.ldlt().solve(wanted.moment + (axes.origin - mean).cross(wanted.force));
  for (int k = 0; k < vertices; ++k) {
    const double w = weight(before_[k]);
    if (!(w > 0.0)) continue;
    const Vec3 force = w * (wanted.force / sum + turn.cross(before_[k] - mean));
    stated_.forces.vertex.push_back(k);
    stated_.forces.force.push_back(force);
    stated_.friction.push_back(force - force.dot(axes.z) * axes.z);
  }
}

TireDiagnostics HandlingTire::diagnostics() const {
  TireDiagnostics d = body_.diagnostics();
  const double deflection = standing_ ? 0.0 : std::max(0.0, motion_of(rim_).deflection);
  d.elastic_energy = spring_energy(formula_, deflection);
  d.dissipation = dissipation_;
  return d;
}

NamedValues HandlingTire::figures() const {
  return {{"patch_along_m", patch_.along}, {"patch_across_m", patch_.across}};
}

void HandlingTire::add_state(Hash& hash) const {
  body_.add_state(hash);
  hash.add(&patch_.along, sizeof patch_.along);
  hash.add(&patch_.across, sizeof patch_.across);
}

void HandlingTire::save(Archive& archive) const {
  body_.save(archive);
  save_fields(archive, "handling", *this);
}

void HandlingTire::do_restore(const Archive& archive) {
  body_.restore(archive);
  restore_fields(archive, "handling", *this);
}

}  // namespace furrow::tire::handling
