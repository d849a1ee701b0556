// The drawbar rig as a multibody system. Frame of travel: e = ±x, l = z × e (left when looking along e), z up. All
// bodies move in the vertical plane of the axle line; the rail carries chassis and set-toe.
#include "rigs/drawbar_rig.hpp"

#include <cmath>
#include <numbers>
#include <optional>

#include "protocol/core/archive_fields.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/key_schema.hpp"
#include "rigs/assembled_rig.hpp"
#include "vehicle/multibody/system.hpp"

namespace furrow::rigs {
namespace {

// Chassis and set-toe rotate only as imposed, so their inertia does not affect any result.
constexpr double kRidingInertia = 1.0;  // kg m²

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

/// Columns of the wheel's table that the rig measures at its longitudinal drive and its damper.
struct DrawbarRow {
  double pull = 0.0;          // raw + m·a of everything the drive carries, N, positive if the tire pulls the rig
  double pull_raw = 0.0;      // reaction of the longitudinal drive, N
  double damper_force = 0.0;  // touch-down damper on the slider, N
  double pull_work = 0.0;     // ∫ raw pull · v dt, J
  double tractive_efficiency = 0.0;  // pull power / spindle power; 0 if the spindle gives no power
  double motion_resistance = 0.0;    // (torque / undeformed radius − pull) / load
};
void visit_fields(FieldsOf<DrawbarRow> auto& r, auto&& visit) {
  using namespace column;
  visit(r.pull, mean("drawbar_pull_N", "N").following("slip"));
  visit(r.pull_raw, mean("drawbar_pull_raw_N", "N").following("energy_error_J"));
  visit(r.damper_force, mean("damper_force_N", "N").following("tire_momentum_travel_kg_m_per_s"));
  visit(r.pull_work, cumulative("pull_work_J", "J").following("spindle_work_J"));
  visit(r.tractive_efficiency, derived("tractive_efficiency"));
  visit(r.motion_resistance, derived("motion_resistance_coefficient"));
}

class DrawbarRig final : public AssembledRig {
 public:
  /// @param hold_axle_from s; negative: never
  DrawbarRig(const DrawbarRigOptions& options, double hold_axle_from)
      : AssembledRig(1, {options.move_from, options.ramp, options.travel_sign}, options.gravity),
        options_(options),
        hold_axle_from_(hold_axle_from) {
    validate(options_);
    FURROW_ASSERT(hold_axle_from < 0.0 || hold_axle_from >= options.touchdown_time, hold_axle_from,
                  options.touchdown_time);
  }

  std::string kind() const override { return hold_axle_from_ < 0.0 ? "drawbar" : "cleat_stand"; }
  std::vector<Subject> subjects() const override { return {{"wheel0", columns_of<DrawbarRow>()}}; }
  void measure(int /*subject*/, std::span<double> values) const override { get_values(row_, values); }
  void derive(int subject, const LineView& line, std::span<double> values) const override;

 private:
  bool free_rolling() const { return options_.mode == "free_rolling"; }
  bool steered() const { return options_.toe_time > 0.0; }
  double travel_speed() const;
  double spin_speed() const;
  double toe_angle() const { return steered() ? system_->coordinate(toe_lock_).value : 0.0; }
  double torque() const { return free_rolling() ? 0.0 : system_->motor_force(spindle_motor_); }
  void build() override;
  Vec3 add_bodies(vehicle::BodyState state);
  void add_motors();
  void add_stop(double travel);
  void hold_axle();
  void begin_rows() override;
  void begin_advance() override;
  void add_step() override;
  void end_advance(double duration, int substeps) override;
  void save_rows(Archive& archive) const override;
  void restore_rows(const Archive& archive) override;

  DrawbarRigOptions options_;
  double hold_axle_from_;                 // s; negative: never
  int set_toe_ = 0;                       // body
  int toe_lock_ = 0, slider_ = 0;         // joints
  int spindle_motor_ = 0, steering_ = 0;  // motors
  int damper_ = 0;                        // force element
  std::optional<double> held_;            // travel of the slider at which the stop holds it, m
  double momentum_ = 0.0, toe_ = 0.0;     // along the rail when the advance began, kg m/s; rad, at the last step
  DrawbarRow row_;
};

// s = 1 − v/(ω r)
double DrawbarRig::travel_speed() const {
  if (options_.mode != "fixed_angular_speed") return options_.speed;
  return options_.angular_speed * tire(0).radius * (1.0 - options_.slip);
}

double DrawbarRig::spin_speed() const {
  if (options_.mode == "fixed_angular_speed") return options_.angular_speed;
  return options_.speed / (tire(0).radius * (free_rolling() ? 1.0 : 1.0 - options_.slip));
}

/// @returns the axle
Vec3 DrawbarRig::add_bodies(vehicle::BodyState state) {
  trolley_ = system_->add_body("chassis", options_.chassis_mass, kRidingInertia * Mat3::Identity(), state);
  if (!steered()) state.orientation = Quat(Eigen::AngleAxisd(options_.toe_angle, Vec3::UnitZ()));
  set_toe_ = system_->add_body("set-toe", options_.set_toe_mass, kRidingInertia * Mat3::Identity(), state);
  // Camber: about the wheel's forward axis.
  state.orientation =
      state.orientation * Quat(Eigen::AngleAxisd(options_.travel_sign * options_.camber_angle, Vec3::UnitX()));
  AssembledWheel& w = wheels_[0];
  w.carrier = system_->add_body("wheel carrier", options_.carrier_mass, kGuidedInertia * Mat3::Identity(), state);
  const Vec3 axle = state.orientation * Vec3::UnitY();
  state.angular_velocity = options_.travel_sign * at_first(spin_speed()) * axle;
  add_rim(w, "rim", options_.rim_mass,
          Vec3(options_.rim_diametral_inertia, options_.rim_spin_inertia, options_.rim_diametral_inertia), state);
  w.carried_mass = options_.carrier_mass + options_.rim_mass + tire(0).mass.mass;
  total_mass_ = 0.0;
  for (int i = 0; i < system_->body_count(); ++i) total_mass_ += mass(i);
  return axle;
}

void DrawbarRig::add_motors() {
  drive_ = system_->add_motor("longitudinal drive", rail_, from_rest(travel_speed()));
  if (!free_rolling())
    spindle_motor_ =
        system_->add_motor("spindle motor", wheels_[0].spindle, from_rest(options_.travel_sign * spin_speed()));
  if (steered())
    steering_ = system_->add_motor("steering", toe_lock_,
                                   [angle = options_.toe_angle, from = options_.toe_time, duration = options_.toe_ramp](
                                       double t) { return vehicle::step_motion(t - from, angle, duration); });
}

void DrawbarRig::build() {
  using vehicle::JointKind;
  AssembledWheel& w = wheels_[0];
  vehicle::BodyState state;
  state.position = Vec3(options_.start, options_.lateral, w.placed_height);
  state.velocity = at_first(travel_speed()) * forward_;
  const Vec3 axle = add_bodies(state);
  const Vec3& centre = state.position;
  rail_ = add_joint(JointKind::prismatic, "rail", vehicle::kGround, trolley_, centre, forward_);
  toe_lock_ = add_joint(steered() ? JointKind::revolute : JointKind::fixed, "toe lock", trolley_, set_toe_, centre,
                        Vec3::UnitZ());
  slider_ = add_joint(JointKind::prismatic, "vertical slider", set_toe_, w.carrier, centre, Vec3::UnitZ());
  w.spindle = add_joint(JointKind::revolute, "spindle", w.carrier, w.rim, centre, axle);
  add_motors();
  damper_ = add_lowering_damper("touch-down damper", slider_, options_.touchdown_damping, options_.touchdown_time);
  held_.reset();
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

void DrawbarRig::begin_rows() {
  row_ = {};
  WheelReport& report = wheels_[0].report;
  report.speed = at_first(travel_speed());
  report.spin = at_first(spin_speed());
  report.slip = report.spin == 0.0 ? 0.0 : 1.0 - report.speed / (report.spin * tire(0).radius);
}

void DrawbarRig::begin_advance() {
  if (!held_ && hold_axle_from_ >= 0.0 && system_->time() >= hold_axle_from_) hold_axle();
  momentum_ = forward_.dot(system_->momentum());
  toe_ = toe_angle();
  row_.pull_raw = row_.damper_force = wheels_[0].report.drive_torque = 0.0;
}

void DrawbarRig::add_step() {
  row_.pull_raw += system_->motor_force(drive_);
  row_.damper_force += system_->element_force(damper_);
  wheels_[0].report.drive_torque += torque();
  accounts_.drive_work += options_.travel_sign * torque() * wheels_[0].turned;
  if (steered()) accounts_.guide_work += system_->motor_force(steering_) * (toe_angle() - toe_);
  toe_ = toe_angle();
}

void DrawbarRig::end_advance(double duration, int substeps) {
  // The drive pushes the rig along e with F_d, so that m a = F_d + F_tire: raw = −F_d, corrected = −F_d + m a.
  row_.pull_raw = -row_.pull_raw / substeps;
  row_.pull = row_.pull_raw + (forward_.dot(system_->momentum()) - momentum_) / duration;
  row_.damper_force /= substeps;
  WheelReport& report = wheels_[0].report;
  report.drive_torque = options_.travel_sign * report.drive_torque / substeps;
  // An explicit fma gives the same bits in every build.
  row_.pull_work = std::fma(duration * row_.pull_raw, report.speed, row_.pull_work);
}

void DrawbarRig::derive(int /*subject*/, const LineView& line, std::span<double> values) const {
  const auto ratio = [](double a, double b) { return b > 0.0 ? a / b : 0.0; };
  const double pull = line["drawbar_pull_N"], torque = line["spindle_torque_Nm"];
  DrawbarRow row;
  row.tractive_efficiency = ratio(pull * line["speed_m_per_s"], torque * line["spin_rad_per_s"]);
  row.motion_resistance = ratio(torque / tire(0).radius - pull, wheels_[0].report.load());
  get_values(row, values);
}

void DrawbarRig::save_rows(Archive& archive) const {
  save_fields(archive, "drawbar", row_);
  if (held_) archive.put("held_travel", *held_);
}

void DrawbarRig::restore_rows(const Archive& archive) {
  restore_fields(archive, "drawbar", row_);
  if (archive.has("held_travel")) add_stop(archive.get_double("held_travel"));
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
