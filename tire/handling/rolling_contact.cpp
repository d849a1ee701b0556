#include "tire/handling/rolling_contact.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "protocol/core/assert.hpp"
#include "protocol/core/constants.hpp"

namespace furrow::tire::handling {
namespace {

constexpr double kDampingRatio = 0.1;  // of the standing patch
constexpr double kLeastLength = 1e-3;  // m, of a relaxation length under a light load
constexpr double kRolls = 0.01;        // m/s: from here on rolling has its whole resistance, which is none at rest
constexpr double kSmall = 1e-9;        // exponent below which the exact solution is taken as a line

/// x after `duration` of ẋ = −slide − speed x/length.
double relaxed(double x, double slide, double speed, double length, double duration) {
  const double exponent = speed * duration / length;
  if (exponent < kSmall) return x - slide * duration;
  const double end = -slide * length / speed;
  return end + (x - end) * std::exp(-exponent);
}

RelaxationLengths lengths_of(const MagicFormula& tire, const ContactMotion& motion) {
  const double load = std::clamp(motion.load, tire.load.least, tire.load.most);
  RelaxationLengths s = relaxation_lengths(tire, load, motion.axes.camber_angle);
  for (double* length : {&s.longitudinal, &s.lateral})
    if (*length > 0.0) *length = std::max(*length, kLeastLength);
  return s;
}

/// What κ (and tan α) gets of the sliding speed while the wheel hardly rolls, s/m: D/K.
double standing(const MagicFormula& tire, const ContactMotion& motion, double stiffness, double length) {
  const double speed = std::abs(motion.travel);
  if (speed >= tire.low_speed || !(stiffness > 0.0)) return 0.0;
  const double mass = motion.load / kStandardGravity;
  const double critical = 2.0 * std::sqrt(stiffness / length * mass);
  return kDampingRatio * critical / stiffness * 0.5 * (1.0 + std::cos(std::numbers::pi * speed / tire.low_speed));
}

/// Seen from the other side, half a turn about z away: a wheel that rolls backward rolls forward there.
ContactMotion turned(ContactMotion motion) {
  motion.travel *= -1.0;
  motion.slip_x *= -1.0;
  motion.slip_y *= -1.0;
  motion.axes.camber_angle *= -1.0;
  return motion;
}

HandlingForces turned(HandlingForces f) {
  for (double* part : {&f.fx, &f.fy, &f.mx, &f.my}) *part *= -1.0;
  return f;
}

/// Of the formula, which holds for a wheel that rolls forward.
HandlingForces forces_forward(const MagicFormula& tire, const ContactMotion& motion, const PatchState& patch) {
  const RelaxationLengths s = lengths_of(tire, motion);
  SlipState at{.load = motion.load, .camber = motion.axes.camber_angle, .speed = motion.travel};
  const double speed = std::max(std::abs(motion.travel), tire.low_speed);
  const HandlingForces still = evaluate(tire, at);
  at.slip = s.longitudinal > 0.0 ? patch.along / s.longitudinal -
                                       standing(tire, motion, still.slip_stiffness, s.longitudinal) * motion.slip_x
                                 : -motion.slip_x / speed;
  const double tangent =
      s.lateral > 0.0
          ? -patch.across / s.lateral + standing(tire, motion, -still.cornering_stiffness, s.lateral) * motion.slip_y
          : motion.slip_y / speed;
  at.slip_angle = std::atan(tangent);
  HandlingForces f = evaluate(tire, at);
  f.my *= std::clamp(motion.travel / kRolls, -1.0, 1.0);
  return f;
}

}  // namespace

ContactMotion contact_motion(const MagicFormula& tire, const RimState& rim, const RoadPlane& road) {
  ContactMotion m;
  const Vec3 axle = rim.orientation * Vec3::UnitY();
  m.axes = road.axes_of(rim, axle.cross(Vec3::UnitZ()).normalized(), tire.dimension.unloaded_radius);
  m.deflection = tire.dimension.unloaded_radius - m.axes.loaded_radius;
  const double spin = rim.angular_velocity.dot(axle), cosine = std::cos(m.axes.camber_angle);
  const Vec3 carried = rim.velocity + (rim.angular_velocity - spin * axle).cross(m.axes.origin - rim.position);
  m.rate = -carried.dot(m.axes.z) / cosine;
  m.travel = carried.dot(m.axes.x);
  m.slip_x = m.travel - spin * rolling_radius(tire, std::max(0.0, m.deflection));
  m.slip_y = carried.dot(m.axes.y);
  if (m.deflection > 0.0)
    m.load = std::max(0.0, spring_force(tire, m.deflection) + tire.vertical.vertical_damping * m.rate) / cosine;
  return m;
}

PatchState advanced(const MagicFormula& tire, const ContactMotion& motion, const PatchState& patch, double duration) {
  FURROW_ASSERT(duration >= 0.0, duration);
  if (!(motion.load > 0.0)) return {};
  const RelaxationLengths s = lengths_of(tire, motion);
  const double speed = std::abs(motion.travel);
  PatchState next;
  const bool back = 2.0 * motion.travel < motion.slip_x;  // contact_forces()
  const double least = back ? -tire.slip.most : tire.slip.least, most = back ? -tire.slip.least : tire.slip.most;
  if (s.longitudinal > 0.0)
    next.along = std::clamp(relaxed(patch.along, motion.slip_x, speed, s.longitudinal, duration),
                            least * s.longitudinal, most * s.longitudinal);
  if (s.lateral > 0.0)
    next.across = std::clamp(relaxed(patch.across, motion.slip_y, speed, s.lateral, duration),
                             -std::tan(tire.slip_angle.most) * s.lateral, -std::tan(tire.slip_angle.least) * s.lateral);
  return next;
}

HandlingForces contact_forces(const MagicFormula& tire, const ContactMotion& motion, const PatchState& patch) {
  if (!(motion.load > 0.0)) return {};
  // Twice the mean of the speeds of axle and tread: a locked wheel slides, and one that spins on the spot drives.
  const double way = 2.0 * motion.travel - motion.slip_x;
  const double forward = std::clamp(0.5 * (1.0 + 0.5 * way / tire.low_speed), 0.0, 1.0);
  if (forward == 1.0) return forces_forward(tire, motion, patch);
  const HandlingForces back = turned(forces_forward(tire, turned(motion), {-patch.along, -patch.across}));
  if (forward == 0.0) return back;
  const HandlingForces ahead = forces_forward(tire, motion, patch);
  const auto mixed = [&](double HandlingForces::*part) { return forward * ahead.*part + (1.0 - forward) * back.*part; };
  return {.fx = mixed(&HandlingForces::fx),
          .fy = mixed(&HandlingForces::fy),
          .fz = mixed(&HandlingForces::fz),
          .mx = mixed(&HandlingForces::mx),
          .my = mixed(&HandlingForces::my),
          .mz = mixed(&HandlingForces::mz),
          .slip_stiffness = mixed(&HandlingForces::slip_stiffness),
          .cornering_stiffness = mixed(&HandlingForces::cornering_stiffness)};
}

}  // namespace furrow::tire::handling
