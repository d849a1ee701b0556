#include "rigs/vehicle/vehicle_rig.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "protocol/core/archive_fields.hpp"
#include "protocol/core/assert.hpp"
#include "rigs/rut_trace.hpp"
#include "rigs/vehicle/vehicle_driving.hpp"
#include "rigs/vehicle/vehicle_findings.hpp"
#include "rigs/vehicle/vehicle_measures.hpp"
#include "rigs/vehicle/vehicle_start.hpp"
#include "rigs/vehicle/wheel_measures.hpp"
#include "vehicle/driver/driver_car.hpp"
#include "vehicle/driver/file_driver.hpp"
#include "vehicle/multibody/statics.hpp"
#include "vehicle/parts/vehicle_energy.hpp"

namespace furrow::rigs {
namespace {

constexpr double kTraceSpacing = 0.05;  // of ruts, in radii
constexpr double kLeastTilt = 0.02;     // rad; grains below the wheels of a level bed differ by less
constexpr double kTraceDepth = 1e-3;    // in radii, below which there is no rut

struct VehicleRecord {
  VehicleRow row;
  RigAccounts accounts = RigAccounts::none();
  vehicle::DriverInputs inputs;
};
void visit_fields(FieldsOf<VehicleRecord> auto& s, auto&& visit) {
  visit(s.row, Field{"row", ""});
  visit(s.accounts, Field{"accounts", ""});
  visit(s.inputs, Field{"inputs", ""});
}

class VehicleRig final : public Rig {
 public:
  explicit VehicleRig(const VehicleRigPlan& plan) : plan_(plan), wheels_(2 * plan.vehicle.axles.size()) {}

  std::string kind() const override { return "vehicle"; }
  int wheel_count() const override { return static_cast<int>(wheels_.size()); }
  Vec3 heading(int wheel) const override { return wheel_heading(*car_, wheel); }
  bool overturned() const override;
  void observe(int wheel, double lowest_point, double ground) override;
  LiveNote live() const override;
  RigFindings findings() const override { return findings_ ? findings_->told() : RigFindings{}; }
  std::vector<Subject> subjects() const override;
  void measure(int subject, std::span<double> values) const override;
  void save_findings(Archive& archive) const override;
  void restore_findings(const Archive& archive) override;

 private:
  void do_place(std::span<const double> axle_height) override;
  RimState do_rim(int wheel) const override { return car_->rim(wheel); }
  Outcome do_advance(std::span<const Wrench> wrenches, double duration, int substeps) override;
  WheelReport do_report(int wheel) const override { return wheels_[wheel].report; }
  RigAccounts do_accounts() const override;
  void do_save(Archive& archive) const override;
  void do_restore(const Archive& archive) override;
  std::vector<double> radii() const;
  std::vector<double> loads() const;
  void build();
  void lift(std::span<const double> axle_height);
  Vec3 upright(std::span<const double> axle_height) const;
  void roll();
  void drive();
  void note_findings(std::span<const Wrench> wrenches);
  bool let_down() const;
  double damping() const;
  Outcome step(std::span<const Wrench> wrenches, double h, std::vector<WheelSums>& sums);
  void book(std::span<const RimState> before, std::span<const Wrench> wrenches, double h);
  void measure_end(int k) { measure_now(*car_, k, plan_.options.heading, wheels_[k]); }

  VehicleRigPlan plan_;
  std::vector<WheelRecord> wheels_;
  VehicleRecord record_;

  std::unique_ptr<vehicle::Vehicle> car_;  // built by place() or restore()
  std::unique_ptr<vehicle::Driver> driver_;
  std::vector<std::vector<TorqueRow>> rows_;  // of each wheel
  std::vector<RutTrace> traces_;              // of each wheel
  vehicle::DriverCar driven_;                 // the driver's data of the vehicle
  std::optional<VehicleFindings> findings_;   // empty until the vehicle moves
  Vec3 seat_ = Vec3::Zero();                  // of the driver's view, in the vehicle's frame, m
};

std::vector<double> VehicleRig::radii() const {
  std::vector<double> radii;
  for (int k = 0; k < wheel_count(); ++k) radii.push_back(tire(k).radius);
  return radii;
}

/// Loads of the wheels at rest, N.
std::vector<double> VehicleRig::loads() const {
  std::vector<double> loads;
  for (const WheelRecord& wheel : wheels_) loads.push_back(wheel.load);
  return loads;
}

void VehicleRig::build() {
  car_ = std::make_unique<vehicle::Vehicle>(plan_.vehicle, plan_.gravity);
  traces_.clear();
  for (int k = 0; k < wheel_count(); ++k) {
    car_->add_tire_mass(k, tire(k).mass);
    traces_.emplace_back(kTraceSpacing * tire(k).radius,
                         plan_.tire_width > 0.0 ? 0.5 * plan_.tire_width : 0.5 * tire(k).radius);
  }
  car_->system().assemble(0.0);
  seat_ = vehicle::rear_axle_middle(plan_.vehicle);
  if (plan_.driver) {
    driven_ = vehicle::driver_car(plan_.vehicle, radii(), plan_.tire_width, car_->mass());
    driver_ = vehicle::make_driver(*plan_.driver, driven_);
  }
  rows_ = torque_rows(*car_);
}

void VehicleRig::do_place(std::span<const double> axle_height) {
  if (!car_) {
    build();
    const vehicle::Trim trim = stand(*car_, radii(), plan_.options.heading);
    for (int k = 0; k < wheel_count(); ++k) wheels_[k].load = trim.wheels[k].load;
    car_->turn(Quat(Eigen::AngleAxisd(plan_.options.heading, Vec3::UnitZ())), car_->origin());
    const Vec3 origin = car_->origin();
    car_->move(Vec3(plan_.options.start - origin.x(), plan_.options.lateral - origin.y(), 0.0));
  }
  lift(axle_height);
  if (plan_.options.start_speed > 0.0) roll();
  if (const Vec3 up = upright(axle_height); up.z() < std::cos(kLeastTilt)) {
    car_->turn(Quat::FromTwoVectors(Vec3::UnitZ(), up), car_->origin());
    lift(axle_height);
  }
  record_ = {};
  record_.inputs = parked();
  for (WheelRecord& wheel : wheels_) wheel = {{}, {}, wheel.load};
  for (int k = 0; k < wheel_count(); ++k) measure_end(k);
  measure_now(*car_, record_.inputs, record_.row);
}

/// Until no axle is below these heights, m.
void VehicleRig::lift(std::span<const double> axle_height) {
  double up = -std::numeric_limits<double>::infinity();
  for (int k = 0; k < wheel_count(); ++k) up = std::max(up, axle_height[k] - car_->rim(k).position.z());
  car_->move(Vec3(0.0, 0.0, up));
}

/// Normal of the plane by least squares through the axles at these heights, as they stand level now.
Vec3 VehicleRig::upright(std::span<const double> axle_height) const {
  Eigen::MatrixXd places(wheel_count(), 3);
  Eigen::VectorXd heights(wheel_count());
  for (int k = 0; k < wheel_count(); ++k) {
    const Vec3 at = car_->rim(k).position;
    places.row(k) << at.x(), at.y(), 1.0;
    heights[k] = axle_height[k] - at.z();
  }
  const Eigen::VectorXd plane = vehicle::shortest_solution(places, heights);
  return Vec3(-plane[0], -plane[1], 1.0).normalized();
}

/// From the first instant on, in the gear that the driver holds then.
void VehicleRig::roll() {
  const bool chosen = plan_.driver && !plan_.driver->inputs.gear.empty();
  car_->begin_rolling(plan_.options.start_speed, radii(),
                      chosen ? std::max(0, static_cast<int>(plan_.driver->inputs.gear.front().second)) : 0);
}

bool VehicleRig::overturned() const { return car_ && car_->system().body(car_->chassis()).R(2, 2) <= 0.0; }

void VehicleRig::drive() {
  if (driver_) record_.inputs = driver_->drive(driver_view(*car_, seat_));
  car_->set_inputs(vehicle_inputs(record_.inputs));
}

void VehicleRig::note_findings(std::span<const Wrench> wrenches) {
  if (!findings_) findings_.emplace(loads(), plan_.driver, driven_);
  const double time = car_->system().time();
  for (int k = 0; k < wheel_count(); ++k) findings_->wheel(k, wrenches[k].force.z(), time);
  if (driver_) findings_->path(driver_view(*car_, seat_), driver_->record());
  findings_->gear(gear_of(*car_, record_.inputs));
}

bool VehicleRig::let_down() const {
  return plan_.options.lowering_speed > 0.0 && car_->system().time() < plan_.options.touchdown_time;
}

double VehicleRig::damping() const { return car_->mass() * plan_.gravity.norm() / plan_.options.lowering_speed; }

Outcome VehicleRig::do_advance(std::span<const Wrench> wrenches, double duration, int substeps) {
  drive();
  note_findings(wrenches);
  const MotionBefore before = MotionBefore::of(*car_);
  const double tire_work = record_.accounts.tire_work;
  std::vector<WheelSums> sums(wheel_count());
  for (int k = 0; k < wheel_count(); ++k) {
    car_->set_wrench(k, wrenches[k]);
    sums[k].from = car_->rim(k).position;
  }
  VehicleRow& row = record_.row;
  begin_driveline(row);
  for (int i = 0; i < substeps; ++i)
    if (Outcome outcome = step(wrenches, duration / substeps, sums); !outcome.ok) return outcome;
  finish_driveline(*car_, before, duration, substeps, row);
  row.soil_power = (tire_work - record_.accounts.tire_work) / duration;
  row.wheel_power = 0.0;
  for (int k = 0; k < wheel_count(); ++k) {
    measure_advance(*car_, k, tire(k).radius, wrenches[k], sums[k], duration, substeps, wheels_[k]);
    measure_end(k);
    row.wheel_power += wheels_[k].report.drive_torque * wheels_[k].report.spin;
  }
  measure_motion(*car_, before, duration, row);
  measure_driver(record_.inputs, driver_.get(), row);
  measure_now(*car_, record_.inputs, row);
  return {};
}

Outcome VehicleRig::step(std::span<const Wrench> wrenches, double h, std::vector<WheelSums>& sums) {
  vehicle::System& system = car_->system();
  const vehicle::BodyState& chassis = system.body(car_->chassis()).state;
  const double lift = let_down() ? -damping() * chassis.velocity.z() : 0.0, height = chassis.position.z();
  system.set_load(car_->chassis(), Vec3(0.0, 0.0, lift), Vec3::Zero());
  std::vector<RimState> before;
  for (int k = 0; k < wheel_count(); ++k) before.push_back(car_->rim(k));
  if (Outcome outcome = car_->step(h); !outcome.ok) return outcome;
  record_.row.lowering_heat -= lift * (chassis.position.z() - height);
  record_.accounts.guide_impulse.z() += h * lift;
  book(before, wrenches, h);
  for (int k = 0; k < wheel_count(); ++k) add_step(*car_, k, before[k], rows_[k], sums[k]);
  add_driveline(*car_, record_.row);
  return {};
}

/// Adds works (mean force times displacement) and impulses of a step to the accounts.
void VehicleRig::book(std::span<const RimState> before, std::span<const Wrench> wrenches, double h) {
  FURROW_ASSERT(before.size() == wrenches.size() && h > 0.0, before.size(), h);
  const vehicle::System& system = car_->system();
  RigAccounts& a = record_.accounts;
  for (int k = 0; k < wheel_count(); ++k) add_tire(a, before[k], car_->rim(k), wrenches[k], h);
  for (int axle = 0; axle < wheel_count() / 2; ++axle)
    if (const auto& steering = std::as_const(*car_).steering(axle))
      a.guide_work += system.motor_force(steering->motor()) *
                      (steering->coordinate(system.time()) - steering->coordinate(system.time() - h));
  a.gravity_impulse += h * car_->mass() * plan_.gravity;
}

void VehicleRig::observe(int k, double lowest_point, double ground) {
  FURROW_ASSERT(in_range(k, wheels_.size()), k, wheels_.size());
  const Vec3 at = rim(k).position;
  double bottom = ground;
  for (int other = 0; other < wheel_count(); ++other)
    if (const auto rut = other == k ? std::nullopt : traces_[other].bottom(at.x(), at.y()))
      bottom = std::min(bottom, *rut);
  wheels_[k].row.sinkage_in_rut = bottom - lowest_point;
  if (ground - lowest_point > kTraceDepth * tire(k).radius) traces_[k].add(Vec3(at.x(), at.y(), lowest_point));
}

LiveNote VehicleRig::live() const {
  const int gear = static_cast<int>(record_.row.gear);
  LiveNote note;
  note.speed = record_.row.speed;
  if (!car_->drive().gearbox()) return note;
  note.text = gear < 0 ? "reverse" : gear == 0 ? "neutral" : fmt::format("gear {}", gear);
  return note;
}

RigAccounts VehicleRig::do_accounts() const {
  const vehicle::VehicleEnergy energy = vehicle::vehicle_energy(*car_);
  RigAccounts now = record_.accounts;
  now.kinetic_energy = energy.kinetic;
  now.potential_energy = energy.gravity + energy.springs;
  now.drive_work = energy.drive_work;
  now.damper_loss = energy.lost() + record_.row.lowering_heat;
  now.momentum = car_->system().momentum();
  return now;
}

std::vector<Subject> VehicleRig::subjects() const {
  std::vector<Subject> all = plain_wheels(wheel_count());
  for (Subject& wheel : all) wheel.columns = columns_of<VehicleWheelRow>();
  all.push_back({"vehicle", columns_of<VehicleRow>()});
  return all;
}

void VehicleRig::measure(int subject, std::span<double> values) const {
  FURROW_ASSERT(subject >= 0 && subject <= wheel_count(), subject, wheel_count());
  if (subject < wheel_count())
    get_values(wheels_[subject].row, values);
  else
    get_values(record_.row, values);
}

void VehicleRig::do_save(Archive& archive) const {
  {
    const Archive::Scope inner(archive, "vehicle/");
    car_->save(archive);
  }
  if (driver_) driver_->save(archive);
  save_fields(archive, "record", record_);
  for (int k = 0; k < wheel_count(); ++k) {
    save_fields(archive, fmt::format("wheel{}", k), wheels_[k]);
    traces_[k].save(archive, fmt::format("rut{}", k));
  }
}

void VehicleRig::save_findings(Archive& archive) const {
  if (findings_) findings_->save(archive);
}

/// @pre restored
void VehicleRig::restore_findings(const Archive& archive) {
  findings_.emplace(loads(), plan_.driver, driven_);
  findings_->restore(archive);
}

void VehicleRig::do_restore(const Archive& archive) {
  build();
  {
    const Archive::Scope inner(archive, "vehicle/");
    car_->restore(archive);
  }
  if (driver_) driver_->restore(archive);
  restore_fields(archive, "record", record_);
  for (int k = 0; k < wheel_count(); ++k) {
    restore_fields(archive, fmt::format("wheel{}", k), wheels_[k]);
    traces_[k].restore(archive, fmt::format("rut{}", k));
  }
}

}  // namespace

std::unique_ptr<Rig> make_vehicle_rig(const VehicleRigPlan& plan) {
  FURROW_ASSERT(plan.options.lowering_speed >= 0.0 && plan.options.touchdown_time >= 0.0, plan.options.lowering_speed,
                plan.options.touchdown_time);
  return std::make_unique<VehicleRig>(plan);
}

}  // namespace furrow::rigs
