#include "rigs/half_car_rig.hpp"

#include <array>
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
constexpr double kHubShare = 0.01;       // of the body: heaves with it and does not pitch
constexpr double kStrutLength = 1.0;     // m, from the front carrier up to the body at rest

struct HalfCarWheel {
  // As made
  double along = 0.0;                     // of the axle ahead of the body's centre, m
  double body_share = 0.0;                // of the body's mass that it carries at rest, kg
  double stiffness = 0.0, damping = 0.0;  // N/m, N s/m
  MassProperties tire;
  double radius = 0.0;         // undeformed, m
  double placed_height = 0.0;  // of the axle, m
  // In the system
  int carrier = 0, rim = 0, slider = 0, spindle = 0, spring = 0;
  // Measured
  WheelReport report;
  RideRow row;
};

class HalfCar final : public Rig {
 public:
  explicit HalfCar(const HalfCarOptions& o) : options_(o) {
    FURROW_ASSERT(o.body_mass > 0.0 && o.pitch_inertia > 0.0 && o.unsprung_mass > 0.0 && o.rim_mass > 0.0, o.body_mass,
                  o.pitch_inertia, o.unsprung_mass, o.rim_mass);
    FURROW_ASSERT(o.wheelbase > 0.0 && o.front_share > 0.0 && o.front_share < 1.0 && o.lowering_speed > 0.0,
                  o.wheelbase, o.front_share, o.lowering_speed);
    FURROW_ASSERT(o.suspension_stiffness >= 0.0 && o.suspension_damping >= 0.0 && o.rear_suspension_stiffness >= 0.0 &&
                      o.rear_suspension_damping >= 0.0,
                  o.suspension_stiffness, o.suspension_damping, o.rear_suspension_stiffness, o.rear_suspension_damping);
    wheels_[0].along = o.wheelbase * (1.0 - o.front_share), wheels_[1].along = -o.wheelbase * o.front_share;
    wheels_[0].body_share = o.body_mass * o.front_share, wheels_[1].body_share = o.body_mass * (1.0 - o.front_share);
    wheels_[0].stiffness = o.suspension_stiffness, wheels_[1].stiffness = o.rear_suspension_stiffness;
    wheels_[0].damping = o.suspension_damping, wheels_[1].damping = o.rear_suspension_damping;
  }

  std::string kind() const override { return "half_car"; }
  int wheel_count() const override { return 2; }
  Vec3 heading(int) const override { return Vec3::UnitX(); }
  std::vector<Subject> subjects() const override {
    return {
        {"wheel0", columns_of<RideRow>()}, {"wheel1", columns_of<RideRow>()}, {"body", columns_of<HalfCarBodyRow>()}};
  }
  void measure(int subject, std::span<double> values) const override {
    if (subject < 2)
      get_values(wheel(subject).row, values);
    else
      get_values(row_, values);
  }

  void add_tire_mass(int wheel, const MassProperties& tire, double tire_radius) override;
  void place(std::span<const double> axle_height) override;
  RimState rim(int wheel) const override;
  Outcome advance(std::span<const Wrench> wrenches, double duration, int substeps) override;
  WheelReport report(int wheel) const override;
  RigAccounts accounts() const override;
  void save(Archive& archive) const override;
  void restore(const Archive& archive) override;

 private:
  const HalfCarWheel& wheel(int k) const {
    FURROW_ASSERT(k == 0 || k == 1, k);
    return wheels_[k];
  }
  double wheel_mass(const HalfCarWheel& w) const { return options_.rim_mass + w.tire.mass; }
  double carried_mass(const HalfCarWheel& w) const { return w.body_share + options_.unsprung_mass + wheel_mass(w); }
  const vehicle::BodyState& state(int body) const { return system_->body(body).state; }
  double pitch() const { return system_->coordinate(hinge_).value; }
  double pitch_rate() const { return state(body_).angular_velocity.y(); }
  Vec3 arm(const HalfCarWheel& w) const { return state(body_).orientation * Vec3(w.along, 0.0, 0.0); }
  /// Of the body above an axle, m/s.
  double rise(const HalfCarWheel& w) const {
    return (state(body_).velocity + state(body_).angular_velocity.cross(arm(w))).z();
  }
  void build();
  void add_wheel(HalfCarWheel& w, const vehicle::BodyState& body);
  struct Stand;
  Stand stand() const;
  void book(const Stand& from, std::span<const Wrench> wrenches, double step);
  void measure_wheel(HalfCarWheel& w);
  void measure_end();

  HalfCarOptions options_;
  std::array<HalfCarWheel, 2> wheels_;     // front, rear
  std::optional<vehicle::System> system_;  // built by place() or restore()
  int trolley_ = 0, hub_ = 0, body_ = 0;   // bodies
  int rail_ = 0, guide_ = 0, hinge_ = 0;   // joints
  int drive_ = 0, lowering_ = 0;           // motor, force element
  HalfCarBodyRow row_;
  RigAccounts accounts_ = RigAccounts::none();
};

/// Where what forces act on stands at the beginning of a step.
struct HalfCar::Stand {
  vehicle::BodyState trolley;
  std::array<vehicle::BodyState, 2> rims;
};

void HalfCar::add_tire_mass(int k, const MassProperties& tire, double tire_radius) {
  FURROW_ASSERT((k == 0 || k == 1) && tire.mass >= 0.0 && tire_radius > 0.0 && !system_, k, tire.mass, tire_radius);
  wheels_[k].tire.mass += tire.mass;
  wheels_[k].tire.inertia += tire.inertia;
  wheels_[k].radius = tire_radius;
}

void HalfCar::build() {
  system_.emplace();
  vehicle::BodyState state;
  state.position = Vec3(options_.start - wheels_[0].along, 0.0, wheels_[0].placed_height + kStrutLength);
  state.velocity = vehicle::ramped_motion(-options_.move_from, options_.speed, options_.ramp).rate * Vec3::UnitX();
  const Mat3 guided = kGuidedInertia * Mat3::Identity();
  const double hub = kHubShare * options_.body_mass;
  trolley_ = system_->add_body("trolley", kTrolleyMass, guided, state);
  hub_ = system_->add_body("hub", hub, guided, state);
  body_ = system_->add_body("body", options_.body_mass - hub, options_.pitch_inertia * Mat3::Identity(), state);
  vehicle::JointPlace place;
  place.point = state.position;
  using vehicle::JointKind;
  const auto along = [&](const Vec3& axis) {
    place.axis = axis;
    return place;
  };
  rail_ = system_->add_joint(JointKind::prismatic, "rail", vehicle::kGround, trolley_, along(Vec3::UnitX()));
  guide_ = system_->add_joint(JointKind::prismatic, "guide", trolley_, hub_, along(Vec3::UnitZ()));
  hinge_ = system_->add_joint(JointKind::revolute, "hinge", hub_, body_, along(Vec3::UnitY()));
  drive_ = system_->add_motor("trolley drive", rail_, [o = options_](double t) {
    return vehicle::ramped_motion(t - o.move_from, o.speed, o.ramp);
  });
  for (HalfCarWheel& w : wheels_) add_wheel(w, state);
  const double brake =
      (carried_mass(wheels_[0]) + carried_mass(wheels_[1])) * kStandardGravity / options_.lowering_speed;
  lowering_ = system_->add_joint_element(
      "lowering damper", guide_, [brake, until = options_.touchdown_time](double, double rate, double t) {
        return t < until ? vehicle::ElementForce{-brake * rate, brake} : vehicle::ElementForce{};
      });
  system_->track_energy(lowering_);
}

void HalfCar::add_wheel(HalfCarWheel& w, const vehicle::BodyState& body) {
  FURROW_ASSERT(w.radius > 0.0 && std::isfinite(w.placed_height), w.radius, w.placed_height);
  const std::string name = w.along > 0.0 ? "front " : "rear ";
  vehicle::BodyState state = body;
  const Vec3 top = body.position + w.along * Vec3::UnitX();
  state.position = Vec3(top.x(), top.y(), w.placed_height);
  w.carrier = system_->add_body(name + "carrier", options_.unsprung_mass, kGuidedInertia * Mat3::Identity(), state);
  state.angular_velocity = state.velocity.x() / w.radius * Vec3::UnitY();
  const Vec3 diagonal(options_.rim_diametral_inertia, options_.rim_spin_inertia, options_.rim_diametral_inertia);
  w.rim = system_->add_body(name + "rim", wheel_mass(w), Mat3(diagonal.asDiagonal()) + w.tire.inertia, state);
  vehicle::JointPlace place;
  place.point = state.position;
  w.slider = system_->add_joint(vehicle::JointKind::prismatic, name + "slider", trolley_, w.carrier, place);
  place.axis = Vec3::UnitY();
  w.spindle = system_->add_joint(vehicle::JointKind::revolute, name + "spindle", w.carrier, w.rim, place);
  const double weight = w.body_share * kStandardGravity, k = w.stiffness, c = w.damping,
               length = top.z() - state.position.z();
  w.spring = system_->add_line_element(
      name + "suspension", w.carrier, body_, state.position, top, [=](double distance, double rate, double) {
        const double s = length - distance, elastic = weight + k * s;
        return vehicle::ElementForce{elastic - c * rate, c, elastic, (weight + 0.5 * k * s) * s};
      });
  system_->track_energy(w.spring);
}

void HalfCar::place(std::span<const double> axle_height) {
  FURROW_ASSERT(axle_height.size() == 2, axle_height.size());
  for (int k = 0; k < 2; ++k) wheels_[k].placed_height = axle_height[k];
  build();
  system_->assemble(0.0);
  row_ = {};
  accounts_ = RigAccounts::none();
  for (HalfCarWheel& w : wheels_) {
    w.report = {};
    w.row = {};
    w.row.force = w.body_share * kStandardGravity;
    w.report.speed = state(w.rim).velocity.x();
    w.report.spin = w.report.speed / w.radius;
  }
  measure_end();
}

RimState HalfCar::rim(int k) const {
  FURROW_ASSERT(system_.has_value());
  const vehicle::BodyState& rim = state(wheel(k).rim);
  return {rim.position, rim.orientation, rim.velocity, rim.angular_velocity};
}

HalfCar::Stand HalfCar::stand() const { return {state(trolley_), {state(wheels_[0].rim), state(wheels_[1].rim)}}; }

Outcome HalfCar::advance(std::span<const Wrench> wrenches, double duration, int substeps) {
  FURROW_ASSERT(wrenches.size() == 2 && substeps >= 1 && duration > 0.0 && system_, wrenches.size(), substeps,
                duration);
  for (int k = 0; k < 2; ++k) {
    if (!wrenches[k].force.allFinite() || !wrenches[k].moment.allFinite())
      return Outcome::failure("was pulled with a wrench that is not finite",
                              "it comes from the tire; try a smaller run.step");
    system_->set_load(wheels_[k].rim, wrenches[k].force, wrenches[k].moment);
  }
  const double step = duration / substeps, rose = state(body_).velocity.z(), pitched = pitch_rate();
  const std::array<double, 2> rises{rise(wheels_[0]), rise(wheels_[1])};
  const Stand begin = stand();
  std::array<double, 2> turn{}, force{}, held{};
  double drive = 0.0;
  for (int i = 0; i < substeps; ++i) {
    const Stand from = stand();
    const std::array<double, 2> angle{system_->coordinate(wheels_[0].spindle).value,
                                      system_->coordinate(wheels_[1].spindle).value};
    if (Outcome outcome = system_->step(step); !outcome.ok) return outcome;
    drive += system_->motor_force(drive_);
    for (int k = 0; k < 2; ++k) {
      const HalfCarWheel& w = wheels_[k];
      turn[k] += std::remainder(system_->coordinate(w.spindle).value - angle[k], 2.0 * std::numbers::pi);
      force[k] += system_->element_force(w.spring);
      held[k] += (system_->joint(w.slider).frame_a.axes * system_->reaction(w.slider).force).x();
    }
    book(from, wrenches, step);
  }
  row_.drive_force = drive / substeps;
  row_.acceleration = (state(body_).velocity.z() - rose) / duration;
  row_.pitch_acceleration = (pitch_rate() - pitched) / duration;
  for (int k = 0; k < 2; ++k) {
    HalfCarWheel& w = wheels_[k];
    w.row.force = force[k] / substeps;
    w.row.drive_force = held[k] / substeps;
    w.row.body_acceleration = (rise(w) - rises[k]) / duration;
    w.report.speed = (state(w.rim).position.x() - begin.rims[k].position.x()) / duration;
    w.report.spin = turn[k] / duration;
    w.report.lateral_force = wrenches[k].force.y();
    w.report.aligning_moment = wrenches[k].moment.z();
    const bool stands = system_->time() <= options_.move_from;
    w.report.slip = stands ? 0.0 : reported_slip(w.report.spin * w.radius, w.report.speed);
  }
  measure_end();
  return {};
}

/// Works and impulses of a step: mean force times way. Nothing but rail, drive and tires acts from outside.
void HalfCar::book(const Stand& from, std::span<const Wrench> wrenches, double step) {
  const Mat3& axes = system_->joint(rail_).frame_a.axes;
  const vehicle::Reaction& reaction = system_->reaction(rail_);
  const Vec3 held = axes * reaction.force, drive = system_->motor_force(drive_) * Vec3::UnitX();
  const Vec3 way = state(trolley_).position - from.trolley.position;
  RigAccounts& a = accounts_;
  a.tow_work += drive.dot(way);
  a.guide_work +=
      held.dot(way) + (axes * reaction.moment).dot(mean_turn(from.trolley.orientation, state(trolley_).orientation));
  double mass = kTrolleyMass;
  for (int k = 0; k < 2; ++k) {
    const vehicle::BodyState &rim = state(wheels_[k].rim), &before = from.rims[k];
    a.tire_work += wrenches[k].force.dot(rim.position - before.position) +
                   wrenches[k].moment.dot(mean_turn(before.orientation, rim.orientation));
    a.tire_impulse += step * wrenches[k].force;
    mass += carried_mass(wheels_[k]);
  }
  a.gravity_impulse += step * mass * standard_gravity();
  a.guide_impulse += step * (held + drive);
}

RigAccounts HalfCar::accounts() const {
  FURROW_ASSERT(system_.has_value());
  RigAccounts now = accounts_;
  now.kinetic_energy = system_->kinetic_energy();
  now.potential_energy = system_->gravity_energy();
  now.damper_loss = system_->element_energy(lowering_).dissipated;
  for (const HalfCarWheel& w : wheels_) {
    now.potential_energy += system_->element_energy(w.spring).stored;
    now.damper_loss += system_->element_energy(w.spring).dissipated;
  }
  now.momentum = system_->momentum();
  return now;
}

void HalfCar::measure_wheel(HalfCarWheel& w) {
  const double height = state(body_).position.z() + arm(w).z(), axle = state(w.rim).position.z();
  w.row.body_height = height - wheels_[0].placed_height - kStrutLength;
  w.row.travel = (wheels_[0].placed_height + kStrutLength - w.placed_height) - (height - axle);
  w.report.axle_height = axle;
  w.report.axle_position = state(w.rim).position.x();
  w.report.vertical_speed = state(w.carrier).velocity.z();
  w.report.carried_mass = carried_mass(w);
  w.report.vertical_momentum = w.body_share * rise(w) + options_.unsprung_mass * state(w.carrier).velocity.z() +
                               wheel_mass(w) * state(w.rim).velocity.z();
  w.report.joint_drift = system_->max_violation();
}

void HalfCar::measure_end() {
  row_.height = state(body_).position.z() - wheels_[0].placed_height - kStrutLength;
  row_.pitch = pitch();
  for (HalfCarWheel& w : wheels_) measure_wheel(w);
}

WheelReport HalfCar::report(int k) const {
  FURROW_ASSERT(system_.has_value());
  return wheel(k).report;
}

void HalfCar::save(Archive& archive) const {
  FURROW_ASSERT(system_.has_value());
  const Archive::Scope scope(archive, "rig/");
  system_->save(archive);
  save_fields(archive, "body", row_);
  save_fields(archive, "accounts", accounts_);
  for (int k = 0; k < 2; ++k) {
    const HalfCarWheel& w = wheels_[k];
    const Archive::Scope inner(archive, k == 0 ? "front/" : "rear/");
    save_fields(archive, "report", w.report);
    save_fields(archive, "ride", w.row);
    archive.put("mass", system_->body(w.rim).mass);
    archive.put("radius", w.radius);
    archive.put("placed_height", w.placed_height);
  }
}

void HalfCar::restore(const Archive& archive) {
  const Archive::Scope scope(archive, "rig/");
  for (int k = 0; k < 2; ++k) {
    const Archive::Scope inner(archive, k == 0 ? "front/" : "rear/");
    HalfCarWheel& w = wheels_[k];
    if (archive.get_double("mass") != wheel_mass(w) || archive.get_double("radius") != w.radius)
      throw Error(ExitCode::io, "saved rig state belongs to another tire (mass or radius differ)");
    w.placed_height = saved_finite(archive, "placed_height");
    restore_fields(archive, "report", w.report);
    restore_fields(archive, "ride", w.row);
  }
  build();
  system_->restore(archive);
  restore_fields(archive, "body", row_);
  restore_fields(archive, "accounts", accounts_);
  measure_end();
}

}  // namespace

std::unique_ptr<Rig> make_half_car(const HalfCarOptions& options) { return std::make_unique<HalfCar>(options); }

}  // namespace furrow::rigs
