#include "rigs/quarter_car_rig.hpp"

#include <cmath>
#include <numbers>
#include <optional>

#include "protocol/core/archive_fields.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "protocol/core/mean_turn.hpp"
#include "protocol/core/saved_number.hpp"
#include "rigs/reported_slip.hpp"
#include "rigs/ride_row.hpp"
#include "vehicle/multibody/system.hpp"

namespace furrow::rigs {
namespace {

// Guided bodies do not turn: their inertia only scales the constraint matrix.
constexpr double kGuidedInertia = 20.0;  // kg m²
constexpr double kTrolleyMass = 1.0;     // kg: rides on the rail and feels nothing but the drive

class QuarterCar final : public Rig {
 public:
  explicit QuarterCar(const QuarterCarOptions& options) : options_(options) {
    FURROW_ASSERT(options.body_mass > 0.0 && options.unsprung_mass > 0.0 && options.rim_mass > 0.0, options.body_mass,
                  options.unsprung_mass, options.rim_mass);
    FURROW_ASSERT(
        options.suspension_stiffness >= 0.0 && options.suspension_damping >= 0.0 && options.lowering_speed > 0.0,
        options.suspension_stiffness, options.suspension_damping, options.lowering_speed);
  }

  std::string kind() const override { return "quarter_car"; }
  int wheel_count() const override { return 1; }
  Vec3 heading(int) const override { return Vec3::UnitX(); }
  std::vector<Subject> subjects() const override { return {{"wheel0", columns_of<RideRow>()}}; }
  void measure(int, std::span<double> values) const override { get_values(row_, values); }

  void add_tire_mass(int wheel, const MassProperties& tire, double tire_radius) override;
  void place(std::span<const double> axle_height) override;
  RimState rim(int wheel) const override;
  Outcome advance(std::span<const Wrench> wrenches, double duration, int substeps) override;
  WheelReport report(int wheel) const override;
  RigAccounts accounts() const override;
  void save(Archive& archive) const override;
  void restore(const Archive& archive) override;

 private:
  double wheel_mass() const { return options_.rim_mass + tire_.mass; }
  double carried_mass() const { return options_.body_mass + options_.unsprung_mass + wheel_mass(); }
  const vehicle::BodyState& state(int body) const { return system_->body(body).state; }
  void build(double axle_height);
  void book(const vehicle::BodyState& trolley, const vehicle::BodyState& rim, const Wrench& wrench, double step);
  void measure_end();

  QuarterCarOptions options_;
  MassProperties tire_;
  double radius_ = 0.0;                                      // undeformed tire radius, m
  std::optional<vehicle::System> system_;                    // built by place() or restore()
  double placed_height_ = 0.0;                               // axle height in which the joints were defined, m
  int trolley_ = 0, body_ = 0, carrier_ = 0, rim_ = 0;       // bodies
  int rail_ = 0, guide_ = 0, suspension_ = 0, spindle_ = 0;  // joints
  int drive_ = 0;                                            // motor
  int lowering_ = 0, spring_ = 0;                            // force elements
  WheelReport report_;
  RideRow row_;
  RigAccounts accounts_ = RigAccounts::none();
};

void QuarterCar::add_tire_mass(int wheel, const MassProperties& tire, double tire_radius) {
  FURROW_ASSERT(wheel == 0 && tire.mass >= 0.0 && tire_radius > 0.0 && !system_, wheel, tire.mass, tire_radius);
  tire_.mass += tire.mass;
  tire_.inertia += tire.inertia;
  radius_ = tire_radius;
}

void QuarterCar::build(double axle_height) {
  FURROW_ASSERT(std::isfinite(axle_height) && radius_ > 0.0, axle_height, radius_);
  system_.emplace();
  placed_height_ = axle_height;
  const vehicle::Motion at_first = vehicle::ramped_motion(-options_.move_from, options_.speed, options_.ramp);
  vehicle::BodyState state;
  state.position = Vec3(options_.start, 0.0, axle_height);
  state.velocity = at_first.rate * Vec3::UnitX();
  const Mat3 guided = kGuidedInertia * Mat3::Identity();
  trolley_ = system_->add_body("trolley", kTrolleyMass, guided, state);
  body_ = system_->add_body("body", options_.body_mass, guided, state);
  carrier_ = system_->add_body("carrier", options_.unsprung_mass, guided, state);
  state.angular_velocity = at_first.rate / radius_ * Vec3::UnitY();
  const Vec3 diagonal(options_.rim_diametral_inertia, options_.rim_spin_inertia, options_.rim_diametral_inertia);
  rim_ = system_->add_body("rim", wheel_mass(), Mat3(diagonal.asDiagonal()) + tire_.inertia, state);
  const auto along = [&](const Vec3& axis) {
    vehicle::JointPlace joint;
    joint.point = state.position;
    joint.axis = axis;
    return joint;
  };
  using vehicle::JointKind;
  rail_ = system_->add_joint(JointKind::prismatic, "rail", vehicle::kGround, trolley_, along(Vec3::UnitX()));
  guide_ = system_->add_joint(JointKind::prismatic, "guide", trolley_, body_, along(Vec3::UnitZ()));
  suspension_ = system_->add_joint(JointKind::prismatic, "suspension", body_, carrier_, along(Vec3::UnitZ()));
  spindle_ = system_->add_joint(JointKind::revolute, "spindle", carrier_, rim_, along(Vec3::UnitY()));
  drive_ = system_->add_motor("trolley drive", rail_, [o = options_](double t) {
    return vehicle::ramped_motion(t - o.move_from, o.speed, o.ramp);
  });
  const double weight = options_.body_mass * kStandardGravity, k = options_.suspension_stiffness,
               c = options_.suspension_damping;
  spring_ = system_->add_joint_element("suspension", suspension_, [=](double s, double rate, double) {
    const double elastic = -(weight + k * s);
    return vehicle::ElementForce{elastic - c * rate, c, elastic, (weight + 0.5 * k * s) * s};
  });
  system_->track_energy(spring_);
  const double brake = carried_mass() * kStandardGravity / options_.lowering_speed;
  lowering_ = system_->add_joint_element(
      "lowering damper", guide_, [brake, until = options_.touchdown_time](double, double rate, double t) {
        return t < until ? vehicle::ElementForce{-brake * rate, brake} : vehicle::ElementForce{};
      });
  system_->track_energy(lowering_);
}

void QuarterCar::place(std::span<const double> axle_height) {
  FURROW_ASSERT(axle_height.size() == 1, axle_height.size());
  build(axle_height[0]);
  system_->assemble(0.0);
  report_ = {};
  row_ = {};
  row_.force = options_.body_mass * kStandardGravity;
  accounts_ = RigAccounts::none();
  report_.speed = state(rim_).velocity.x();
  report_.spin = report_.speed / radius_;
  measure_end();
}

RimState QuarterCar::rim(int wheel) const {
  FURROW_ASSERT(wheel == 0 && system_, wheel);
  const vehicle::BodyState& rim = state(rim_);
  return {rim.position, rim.orientation, rim.velocity, rim.angular_velocity};
}

Outcome QuarterCar::advance(std::span<const Wrench> wrenches, double duration, int substeps) {
  FURROW_ASSERT(wrenches.size() == 1 && substeps >= 1 && duration > 0.0 && system_, wrenches.size(), substeps,
                duration);
  const Wrench& wrench = wrenches[0];
  if (!wrench.force.allFinite() || !wrench.moment.allFinite())
    return Outcome::failure("was pulled with a wrench that is not finite",
                            "it comes from the tire; try a smaller run.step");
  system_->set_load(rim_, wrench.force, wrench.moment);
  const double step = duration / substeps, rise = state(body_).velocity.z(), at = state(rim_).position.x();
  double force = 0.0, drive = 0.0, turn = 0.0;
  for (int i = 0; i < substeps; ++i) {
    const vehicle::BodyState trolley = state(trolley_), rim = state(rim_);
    const double angle = system_->coordinate(spindle_).value;
    if (Outcome outcome = system_->step(step); !outcome.ok) return outcome;
    force -= system_->element_force(spring_);
    drive += system_->motor_force(drive_);
    turn += std::remainder(system_->coordinate(spindle_).value - angle, 2.0 * std::numbers::pi);
    book(trolley, rim, wrench, step);
  }
  row_.force = force / substeps;
  row_.drive_force = drive / substeps;
  row_.body_acceleration = (state(body_).velocity.z() - rise) / duration;
  report_.speed = (state(rim_).position.x() - at) / duration;
  report_.spin = turn / duration;
  report_.lateral_force = wrench.force.y();
  report_.aligning_moment = wrench.moment.z();
  const bool stands = system_->time() <= options_.move_from;
  report_.slip = stands ? 0.0 : reported_slip(report_.spin * radius_, report_.speed);
  measure_end();
  return {};
}

/// Works and impulses of a step: mean force times way.
void QuarterCar::book(const vehicle::BodyState& trolley, const vehicle::BodyState& rim, const Wrench& wrench,
                      double step) {
  const Mat3& axes = system_->joint(rail_).frame_a.axes;
  const vehicle::Reaction& reaction = system_->reaction(rail_);
  const Vec3 held = axes * reaction.force, drive = system_->motor_force(drive_) * Vec3::UnitX();
  const Vec3 way = state(trolley_).position - trolley.position;
  RigAccounts& a = accounts_;
  a.tow_work += drive.dot(way);
  a.guide_work +=
      held.dot(way) + (axes * reaction.moment).dot(mean_turn(trolley.orientation, state(trolley_).orientation));
  a.tire_work += wrench.force.dot(state(rim_).position - rim.position) +
                 wrench.moment.dot(mean_turn(rim.orientation, state(rim_).orientation));
  a.gravity_impulse += step * (carried_mass() + kTrolleyMass) * standard_gravity();
  a.guide_impulse += step * (held + drive);
  a.tire_impulse += step * wrench.force;
}

RigAccounts QuarterCar::accounts() const {
  FURROW_ASSERT(system_.has_value());
  const vehicle::ElementEnergy spring = system_->element_energy(spring_), lowering = system_->element_energy(lowering_);
  RigAccounts now = accounts_;
  now.kinetic_energy = system_->kinetic_energy();
  now.potential_energy = system_->gravity_energy() + spring.stored;
  now.damper_loss = spring.dissipated + lowering.dissipated;
  now.momentum = system_->momentum();
  return now;
}

void QuarterCar::measure_end() {
  row_.body_height = state(body_).position.z() - placed_height_;
  row_.travel = system_->coordinate(suspension_).value;
  report_.axle_height = state(rim_).position.z();
  report_.axle_position = state(rim_).position.x();
  report_.vertical_speed = state(carrier_).velocity.z();
  report_.carried_mass = carried_mass();
  report_.vertical_momentum = options_.body_mass * state(body_).velocity.z() +
                              options_.unsprung_mass * state(carrier_).velocity.z() +
                              wheel_mass() * state(rim_).velocity.z();
  report_.joint_drift = system_->max_violation();
}

WheelReport QuarterCar::report(int wheel) const {
  FURROW_ASSERT(wheel == 0 && system_, wheel);
  return report_;
}

void QuarterCar::save(Archive& archive) const {
  FURROW_ASSERT(system_.has_value());
  const Archive::Scope scope(archive, "rig/");
  system_->save(archive);
  save_fields(archive, "report", report_);
  save_fields(archive, "quarter_car", row_);
  save_fields(archive, "accounts", accounts_);
  archive.put("mass", system_->body(rim_).mass);
  archive.put("radius", radius_);
  archive.put("placed_height", placed_height_);
}

void QuarterCar::restore(const Archive& archive) {
  const Archive::Scope scope(archive, "rig/");
  build(saved_finite(archive, "placed_height"));
  if (archive.get_double("mass") != system_->body(rim_).mass || archive.get_double("radius") != radius_)
    throw Error(ExitCode::io, "saved rig state belongs to another tire (mass or radius differ)");
  system_->restore(archive);
  restore_fields(archive, "report", report_);
  restore_fields(archive, "quarter_car", row_);
  restore_fields(archive, "accounts", accounts_);
  measure_end();
}

}  // namespace

std::unique_ptr<Rig> make_quarter_car(const QuarterCarOptions& options) {
  return std::make_unique<QuarterCar>(options);
}

}  // namespace furrow::rigs
