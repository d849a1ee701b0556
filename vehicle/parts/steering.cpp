#include "vehicle/parts/steering.hpp"

#include <cmath>
#include <numbers>

#include "protocol/core/archive_fields.hpp"
#include "protocol/core/assert.hpp"
#include "vehicle/parts/suspension.hpp"

namespace furrow::vehicle {

// With e = s − s*: e = (e₀ + (s′₀ + e₀/T) t) exp(−t/T).
Motion Steering::Follower::at(double time) const {
  const double T = response_time, t = time - state.since, e = state.value - state.target;
  const double slope = state.rate + e / T, decay = std::exp(-t / T);
  return {state.target + (e + slope * t) * decay, (slope - (e + slope * t) / T) * decay};
}

Motion Steering::input(double time) const { return follower_->at(time); }

void Steering::set_target(double time, double target) {
  FURROW_ASSERT(target >= -1.0 && target <= 1.0, target);
  if (target == follower_->state.target) return;
  const Motion now = follower_->at(time);
  follower_->state = {time, now.value, now.rate, target};
}

void Steering::put(double value) { follower_->state = {0.0, value, 0.0, value}; }

Steering::Steering(System& system, const std::string& axle, const SteeringSpec& spec, int chassis) {
  if (const auto* arm = std::get_if<PitmanArmSpec>(&spec))
    add_pitman_arm(system, axle, *arm, chassis);
  else
    add_rack(system, axle, std::get<RackSpec>(spec), chassis);
}

void Steering::add_motor(System& system, const std::string& axle, int joint, double full_left, double response_time) {
  follower_->response_time = response_time;
  full_left_ = full_left;
  motor_ = system.add_motor(axle + " steering", joint, [follower = follower_, full_left](double time) {
    const Motion input = follower->at(time);
    return Motion{full_left * input.value, full_left * input.rate};
  });
}

void Steering::add_pitman_arm(System& system, const std::string& axle, const PitmanArmSpec& s, int chassis) {
  const Quat axes(Eigen::AngleAxisd(s.pitch_deg * std::numbers::pi / 180.0, Vec3::UnitY()));
  const auto at = [&](const Vec3& point) { return Vec3(s.origin + axes * point); };
  const auto body = [&](const std::string& name, const BodySpec& spec) {
    return system.add_body(axle + " " + name, spec.mass, spec.inertia,
                           {.position = at(spec.center_of_mass), .orientation = axes});
  };
  const int arm = body("Pitman arm", s.arm);
  rods_ = body("steering link", s.link);
  const Vec3 axis = axes * Vec3::UnitZ();
  const int pivot = add_joint(system, JointKind::revolute, axle + " Pitman pivot", chassis, arm, at(s.pivot), axis);
  system.add_joint(JointKind::universal, axle + " Pitman cross", arm, rods_,
                   {.point = at(s.arm_end), .axis = axis, .second_axis = axes * (s.arm_end - s.pivot)});
  system.add_joint(JointKind::revolute_spherical, axle + " idler", chassis, rods_,
                   {.point = at(s.idler), .axis = axis, .second_point = at(s.idler_end)});
  add_motor(system, axle, pivot, s.left_angle_deg * std::numbers::pi / 180.0, s.response_time);
}

void Steering::add_rack(System& system, const std::string& axle, const RackSpec& s, int chassis) {
  rods_ = add_body(system, axle + " rack", s.rack);
  const int slide = add_joint(system, JointKind::prismatic, axle + " rack slide", chassis, rods_, s.rack.center_of_mass,
                              Vec3::UnitY());
  add_motor(system, axle, slide, s.left_travel, s.response_time);
}

void Steering::save(Archive& archive) const { save_fields(archive, "steering", follower_->state); }

void Steering::restore(const Archive& archive) { restore_fields(archive, "steering", follower_->state); }

}  // namespace furrow::vehicle
