// The drawbar rig as a multibody system. Frame of travel: e = ±x, l = z × e (left when looking along e), z
// up. All bodies ride in the vertical plane of the axle line; chassis and set-toe are carried by the rail.
#include "rigs/drawbar_rig.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "protocol/core/archive_fields.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "protocol/core/mean_turn.hpp"
#include "protocol/core/saved_number.hpp"
#include "protocol/files/key_schema.hpp"
#include "rigs/reported_slip.hpp"
#include "vehicle/multibody/system.hpp"

namespace furrow::rigs {
namespace {

// Guided bodies rotate only as imposed, so their inertia has no effect on any result; it only scales the
// constraint matrix.
constexpr double kGuidedInertia = 1.0;    // kg m², chassis and set-toe
constexpr double kCarrierInertia = 20.0;  // kg m²

void validate(const DrawbarRigOptions& o) {
  check_values(o, "scenario", "rig");
  if (o.mode == "fixed_speed" && !(o.slip < 1.0))
    throw input_error("scenario", "rig.slip", "must be below 1 in mode fixed_speed");
  const std::pair<const char*, double> masses[] = {{"carrier_mass", o.carrier_mass},
                                                   {"rim_mass", o.rim_mass},
                                                   {"rim_spin_inertia", o.rim_spin_inertia},
                                                   {"rim_diametral_inertia", o.rim_diametral_inertia}};
  for (const auto& [key, mass] : masses)
    if (!(mass > 0.0))
      throw input_error("scenario", std::string("rig.") + key, "is missing, expected a number above 0");
  FURROW_ASSERT(std::abs(o.travel_sign) == 1.0, o.travel_sign);
  FURROW_ASSERT(o.touchdown_damping >= 0.0 && o.touchdown_time >= 0.0, o.touchdown_damping, o.touchdown_time);
}

/// What the rig measures with its longitudinal drive and its damper: columns of the wheel's table.
struct DrawbarRow {
  double pull = 0.0;          // raw + m·a of everything the drive carries, N, positive when the tire pulls the rig
  double pull_raw = 0.0;      // reaction of the longitudinal drive, N
  double damper_force = 0.0;  // touch-down damper on the slider, N
  double pull_work = 0.0;     // ∫ raw pull · v dt, J
  double tractive_efficiency = 0.0;  // pull power / spindle power; 0 where the spindle gives none
  double motion_resistance = 0.0;    // (torque / undeformed radius − pull) / load
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<DrawbarRow> auto& r) {
  using namespace column;
  visit(mean("drawbar_pull_N", "N").following("slip"), r.pull);
  visit(mean("drawbar_pull_raw_N", "N").following("energy_error_J"), r.pull_raw);
  visit(mean("damper_force_N", "N").following("tire_momentum_travel_kg_m_per_s"), r.damper_force);
  visit(cumulative("pull_work_J", "J").following("spindle_work_J"), r.pull_work);
  visit(derived("tractive_efficiency"), r.tractive_efficiency);
  visit(derived("motion_resistance_coefficient"), r.motion_resistance);
}

class DrawbarRig final : public Rig {
 public:
  /// @param hold_axle_from s; negative: never
  DrawbarRig(const DrawbarRigOptions& options, double hold_axle_from)
      : options_(options), hold_axle_from_(hold_axle_from) {
    validate(options_);
    FURROW_ASSERT(hold_axle_from < 0.0 || hold_axle_from >= options.touchdown_time, hold_axle_from,
                  options.touchdown_time);
    forward_ = Vec3(options_.travel_sign, 0.0, 0.0);
    left_ = Vec3::UnitZ().cross(forward_);
  }

  std::string kind() const override { return hold_axle_from_ < 0.0 ? "drawbar" : "cleat_stand"; }
  int wheel_count() const override { return 1; }
  Vec3 heading(int wheel) const override {
    check_wheel(wheel);
    return forward_;
  }

  void add_tire_mass(int wheel, const MassProperties& tire, double tire_radius) override;
  void place(std::span<const double> axle_height) override;
  RimState rim(int wheel) const override;
  Outcome advance(std::span<const Wrench> wrenches, double duration, int substeps) override;
  WheelReport report(int wheel) const override;
  RigAccounts accounts() const override;
  std::vector<Subject> subjects() const override { return {{"wheel0", columns_of<DrawbarRow>()}}; }
  void measure(int /*subject*/, std::span<double> values) const override { get_values(row_, values); }
  void derive(int subject, const LineView& line, std::span<double> values) const override;
  void save(Archive& archive) const override;
  void restore(const Archive& archive) override;

 private:
  bool free_rolling() const { return options_.mode == "free_rolling"; }
  bool steered() const { return options_.toe_time > 0.0; }
  void check_wheel(int wheel) const;
  void check_built() const;
  void set_speeds();
  void build(double axle_height);
  void add_stop(double travel);
  void hold_axle();
  vehicle::BodyState moving(double axle_height) const;
  double forward_momentum() const { return forward_.dot(system_->momentum()); }
  double spin_angle() const { return options_.travel_sign * system_->coordinate(spindle_).value; }
  double toe_angle() const { return steered() ? system_->coordinate(toe_lock_).value : 0.0; }
  void measure_end();
  struct Stand;
  Stand stand() const;
  void book(const Stand& before, double turned, const Wrench& wrench, double step);

  DrawbarRigOptions options_;
  double hold_axle_from_;  // s; negative: never
  Vec3 forward_, left_;
  double radius_ = 0.0;        // undeformed tire radius, m
  double travel_speed_ = 0.0;  // after the ramp, along travel, m/s
  double spin_speed_ = 0.0;    // after the ramp, forward positive, rad/s
  MassProperties tire_;

  std::optional<vehicle::System> system_;                   // built by place() or restore()
  double placed_height_ = 0.0;                              // axle height in which the joints were defined, m
  int chassis_ = 0, set_toe_ = 0, carrier_ = 0, rim_ = 0;   // bodies
  int rail_ = 0, toe_lock_ = 0, slider_ = 0, spindle_ = 0;  // joints
  int drive_ = 0, spindle_motor_ = 0, steering_ = 0;        // motors
  int damper_ = 0;                                          // force element
  std::optional<double> held_;                              // travel of the slider at which the stop holds it, m
  WheelReport report_;
  DrawbarRow row_;
  RigAccounts accounts_ = RigAccounts::none();
};

/// Where what forces act on stands at the beginning of a step.
struct DrawbarRig::Stand {
  Vec3 chassis = Vec3::Zero(), rim = Vec3::Zero();  // m
  Quat chassis_turn = Quat::Identity(), rim_turn = Quat::Identity();
  double toe = 0.0;  // rad
};

void DrawbarRig::check_wheel(int wheel) const {
  if (wheel != 0)
    throw physics_error("drawbar rig: it has one wheel, wheel " + std::to_string(wheel) + " was asked for");
}

void DrawbarRig::check_built() const {
  if (!system_) throw physics_error("drawbar rig: it must be placed before it moves");
}

void DrawbarRig::add_tire_mass(int wheel, const MassProperties& tire, double tire_radius) {
  FURROW_ASSERT(tire.mass >= 0.0 && tire.inertia.allFinite(), tire.mass);
  check_wheel(wheel);
  if (system_) throw physics_error("drawbar rig: tire mass must be added before the rig is placed");
  if (!(tire_radius > 0.0)) throw physics_error("drawbar rig: the tire radius must be positive");
  tire_.mass += tire.mass;
  tire_.inertia += tire.inertia;
  radius_ = tire_radius;
  set_speeds();
}

// s = 1 − v/(ω r)
void DrawbarRig::set_speeds() {
  if (options_.mode == "fixed_angular_speed") {
    spin_speed_ = options_.angular_speed;
    travel_speed_ = spin_speed_ * radius_ * (1.0 - options_.slip);
  } else {
    travel_speed_ = options_.speed;
    spin_speed_ = travel_speed_ / (radius_ * (free_rolling() ? 1.0 : 1.0 - options_.slip));
  }
}

vehicle::BodyState DrawbarRig::moving(double axle_height) const {
  FURROW_ASSERT(std::isfinite(travel_speed_) && options_.ramp >= 0.0, travel_speed_, options_.ramp);
  vehicle::BodyState state;
  state.position = Vec3(options_.start, options_.lateral, axle_height);
  state.velocity = vehicle::ramped_motion(-options_.move_from, travel_speed_, options_.ramp).rate * forward_;
  return state;
}

void DrawbarRig::build(double axle_height) {
  FURROW_ASSERT(std::isfinite(axle_height), axle_height);
  FURROW_ASSERT(radius_ > 0.0, radius_);
  system_.emplace(options_.gravity);
  held_.reset();
  placed_height_ = axle_height;
  vehicle::BodyState state = moving(axle_height);
  chassis_ = system_->add_body("chassis", options_.chassis_mass, kGuidedInertia * Mat3::Identity(), state);
  if (!steered()) state.orientation = Quat(Eigen::AngleAxisd(options_.toe_angle, Vec3::UnitZ()));
  set_toe_ = system_->add_body("set-toe", options_.set_toe_mass, kGuidedInertia * Mat3::Identity(), state);
  // Camber: about the wheel's forward axis.
  state.orientation =
      state.orientation * Quat(Eigen::AngleAxisd(options_.travel_sign * options_.camber_angle, Vec3::UnitX()));
  carrier_ = system_->add_body("wheel carrier", options_.carrier_mass, kCarrierInertia * Mat3::Identity(), state);
  const Vec3 axle = state.orientation * Vec3::UnitY();
  const Vec3 diagonal(options_.rim_diametral_inertia, options_.rim_spin_inertia, options_.rim_diametral_inertia);
  state.angular_velocity =
      options_.travel_sign * vehicle::ramped_motion(-options_.move_from, spin_speed_, options_.ramp).rate * axle;
  rim_ = system_->add_body("rim", options_.rim_mass + tire_.mass, Mat3(diagonal.asDiagonal()) + tire_.inertia, state);

  const Vec3 centre = state.position;
  const auto place = [&](const Vec3& axis) {
    vehicle::JointPlace joint;
    joint.point = centre;
    joint.axis = axis;
    return joint;
  };
  rail_ = system_->add_joint(vehicle::JointKind::prismatic, "rail", vehicle::kGround, chassis_, place(forward_));
  toe_lock_ = system_->add_joint(steered() ? vehicle::JointKind::revolute : vehicle::JointKind::fixed, "toe lock",
                                 chassis_, set_toe_, place(Vec3::UnitZ()));
  slider_ =
      system_->add_joint(vehicle::JointKind::prismatic, "vertical slider", set_toe_, carrier_, place(Vec3::UnitZ()));
  spindle_ = system_->add_joint(vehicle::JointKind::revolute, "spindle", carrier_, rim_, place(axle));
  const auto from_rest = [ramp = options_.ramp, from = options_.move_from](double speed) {
    return [=](double t) { return vehicle::ramped_motion(t - from, speed, ramp); };
  };
  drive_ = system_->add_motor("longitudinal drive", rail_, from_rest(travel_speed_));
  if (!free_rolling()) {
    spindle_motor_ = system_->add_motor("spindle motor", spindle_, from_rest(options_.travel_sign * spin_speed_));
  }
  if (steered())
    steering_ = system_->add_motor("steering", toe_lock_,
                                   [angle = options_.toe_angle, from = options_.toe_time, duration = options_.toe_ramp](
                                       double t) { return vehicle::step_motion(t - from, angle, duration); });
  const double c = options_.touchdown_damping, until = options_.touchdown_time;
  damper_ = system_->add_joint_element("touch-down damper", slider_, [c, until](double, double rate, double t) {
    return t < until ? vehicle::ElementForce{-c * rate, c} : vehicle::ElementForce{};
  });
  system_->track_energy(damper_);
}

void DrawbarRig::add_stop(double travel) {
  held_ = travel;
  system_->add_motor("stop of the axle", slider_, [travel](double) { return vehicle::Motion{travel, 0.0}; });
}

void DrawbarRig::hold_axle() {
  const Vec3 momentum = system_->momentum();
  const double energy = system_->kinetic_energy();
  add_stop(system_->coordinate(slider_).value);
  system_->assemble(system_->time());
  accounts_.guide_impulse += system_->momentum() - momentum;
  accounts_.guide_work += system_->kinetic_energy() - energy;
}

void DrawbarRig::place(std::span<const double> axle_height) {
  if (axle_height.size() != 1) throw physics_error("drawbar rig: expected one axle height");
  if (!std::isfinite(axle_height[0])) throw physics_error("drawbar rig: the axle height is not finite");
  if (!(radius_ > 0.0)) throw physics_error("drawbar rig: the tire's mass and radius must be added before placing");
  build(axle_height[0]);
  system_->assemble(0.0);
  report_ = {};
  row_ = {};
  accounts_ = RigAccounts::none();
  report_.speed = vehicle::ramped_motion(-options_.move_from, travel_speed_, options_.ramp).rate;
  report_.spin = vehicle::ramped_motion(-options_.move_from, spin_speed_, options_.ramp).rate;
  report_.slip = report_.spin == 0.0 ? 0.0 : 1.0 - report_.speed / (report_.spin * radius_);
  measure_end();
}

RimState DrawbarRig::rim(int wheel) const {
  check_wheel(wheel);
  check_built();
  const vehicle::BodyState& state = system_->body(rim_).state;
  return {state.position, state.orientation, state.velocity, state.angular_velocity};
}

Outcome DrawbarRig::advance(std::span<const Wrench> wrenches, double duration, int substeps) {
  check_built();
  FURROW_ASSERT(wrenches.size() == 1, wrenches.size());
  FURROW_ASSERT(substeps >= 1 && duration > 0.0, substeps, duration);
  const Wrench& wrench = wrenches[0];
  if (!wrench.force.allFinite() || !wrench.moment.allFinite())
    return Outcome::failure("was pulled with a wrench that is not finite",
                            "it comes from the tire; try a smaller run.step");
  if (!held_ && hold_axle_from_ >= 0.0 && system_->time() >= hold_axle_from_) hold_axle();
  system_->set_load(rim_, wrench.force, wrench.moment);

  const double step = duration / substeps;
  const double momentum = forward_momentum();
  const double position = forward_.dot(system_->body(rim_).state.position);
  double drive = 0.0, torque = 0.0, damper = 0.0, turn = 0.0, angle = spin_angle();
  for (int i = 0; i < substeps; ++i) {
    const Stand from = stand();
    Outcome outcome = system_->step(step);
    if (!outcome.ok) return outcome;
    drive += system_->motor_force(drive_);
    if (!free_rolling()) torque += system_->motor_force(spindle_motor_);
    damper += system_->element_force(damper_);
    const double before = angle;
    angle = spin_angle();
    const double turned = std::remainder(angle - before, 2.0 * std::numbers::pi);
    turn += turned;
    book(from, turned, wrench, step);
  }
  report_.speed = (forward_.dot(system_->body(rim_).state.position) - position) / duration;
  report_.spin = turn / duration;
  // The drive pushes the rig along e with F_d, so that m a = F_d + F_tire: raw = −F_d, corrected = −F_d + m
  // a.
  row_.pull_raw = -drive / substeps;
  row_.pull = row_.pull_raw + (forward_momentum() - momentum) / duration;
  report_.drive_torque = options_.travel_sign * torque / substeps;
  row_.damper_force = damper / substeps;
  report_.lateral_force = wrench.force.dot(left_);
  report_.aligning_moment = wrench.moment.z();
  const bool stands = options_.move_from > 0.0 && system_->time() <= options_.move_from;
  report_.slip = stands ? 0.0 : reported_slip(report_.spin * radius_, report_.speed);
  measure_end();
  // Fused whatever else the compiler does here: the same bits in every build.
  row_.pull_work = std::fma(duration * row_.pull_raw, report_.speed, row_.pull_work);
  return {};
}

DrawbarRig::Stand DrawbarRig::stand() const {
  const vehicle::BodyState &chassis = system_->body(chassis_).state, &rim = system_->body(rim_).state;
  return {chassis.position, rim.position, chassis.orientation, rim.orientation, toe_angle()};
}

/// Works and impulses of a step: mean force times way. A joint's reaction acts on body B in the axes of its frame on A,
/// the rail's A being the ground; the damper's loss is the system's own account.
void DrawbarRig::book(const Stand& from, double turned, const Wrench& wrench, double step) {
  FURROW_ASSERT(step > 0.0 && std::isfinite(turned), step, turned);
  const Stand to = stand();
  const Mat3& axes = system_->joint(rail_).frame_a.axes;
  const vehicle::Reaction& reaction = system_->reaction(rail_);
  const Vec3 rail = axes * reaction.force, rail_moment = axes * reaction.moment,
             drive = system_->motor_force(drive_) * forward_;
  const double torque = free_rolling() ? 0.0 : options_.travel_sign * system_->motor_force(spindle_motor_);
  RigAccounts& a = accounts_;
  a.drive_work += torque * turned;
  a.tow_work += drive.dot(to.chassis - from.chassis);
  a.guide_work += rail.dot(to.chassis - from.chassis) + rail_moment.dot(mean_turn(from.chassis_turn, to.chassis_turn));
  if (steered()) a.guide_work += system_->motor_force(steering_) * (to.toe - from.toe);
  a.tire_work += wrench.force.dot(to.rim - from.rim) + wrench.moment.dot(mean_turn(from.rim_turn, to.rim_turn));
  double mass = 0.0;
  for (int i = 0; i < system_->body_count(); ++i) mass += system_->body(i).mass;
  a.gravity_impulse += step * mass * options_.gravity;
  a.guide_impulse += step * (rail + drive);
  a.tire_impulse += step * wrench.force;
}

RigAccounts DrawbarRig::accounts() const {
  check_built();
  RigAccounts now = accounts_;
  now.kinetic_energy = system_->kinetic_energy();
  now.potential_energy = system_->gravity_energy();
  now.damper_loss = system_->element_energy(damper_).dissipated;
  now.momentum = system_->momentum();
  return now;
}

void DrawbarRig::measure_end() {
  FURROW_ASSERT(system_.has_value(), placed_height_);
  const vehicle::BodyState& rim = system_->body(rim_).state;
  report_.axle_height = rim.position.z();
  report_.axle_position = forward_.dot(rim.position);
  report_.vertical_speed = system_->body(carrier_).state.velocity.z();
  report_.carried_mass = options_.carrier_mass + options_.rim_mass + tire_.mass;
  report_.vertical_momentum =
      options_.carrier_mass * report_.vertical_speed + (options_.rim_mass + tire_.mass) * rim.velocity.z();
  report_.joint_drift = system_->max_violation();
  report_.gravity = options_.gravity;
}

WheelReport DrawbarRig::report(int wheel) const {
  check_wheel(wheel);
  check_built();
  return report_;
}

void DrawbarRig::derive(int /*subject*/, const LineView& line, std::span<double> values) const {
  const auto ratio = [](double a, double b) { return b != 0.0 ? a / b : 0.0; };
  const double pull = line["drawbar_pull_N"], torque = line["spindle_torque_Nm"];
  DrawbarRow row;
  row.tractive_efficiency = ratio(pull * line["speed_m_per_s"], torque * line["spin_rad_per_s"]);
  row.motion_resistance = ratio(torque / radius_ - pull, report_.load());
  get_values(row, values);
}

void DrawbarRig::save(Archive& archive) const {
  check_built();
  const Archive::Scope scope(archive, "rig/");
  system_->save(archive);
  save_fields(archive, "report", report_);
  save_fields(archive, "drawbar", row_);
  save_fields(archive, "accounts", accounts_);
  archive.put("mass", system_->body(rim_).mass);
  archive.put("radius", radius_);
  archive.put("placed_height", placed_height_);
  if (held_) archive.put("held_travel", *held_);
}

void DrawbarRig::restore(const Archive& archive) {
  const Archive::Scope scope(archive, "rig/");
  build(saved_finite(archive, "placed_height"));
  if (archive.has("held_travel")) add_stop(archive.get_double("held_travel"));
  if (archive.get_double("mass") != system_->body(rim_).mass || archive.get_double("radius") != radius_)
    throw Error(ExitCode::io, "saved rig state belongs to another tire (mass or radius differ)");
  system_->restore(archive);
  restore_fields(archive, "report", report_);
  restore_fields(archive, "drawbar", row_);
  restore_fields(archive, "accounts", accounts_);
  measure_end();
}

}  // namespace

std::unique_ptr<Rig> make_drawbar_rig(const DrawbarRigOptions& options) {
  return std::make_unique<DrawbarRig>(options, -1.0);
}

std::unique_ptr<Rig> make_held_drawbar_rig(const DrawbarRigOptions& options, double hold_axle_from) {
  FURROW_ASSERT(hold_axle_from >= 0.0, hold_axle_from);
  return std::make_unique<DrawbarRig>(options, hold_axle_from);
}

}  // namespace furrow::rigs
