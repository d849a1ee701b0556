#include "vehicle/parts/drive_train.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "protocol/core/archive_fields.hpp"
#include "protocol/core/assert.hpp"
#include "vehicle/driveline/gears.hpp"
#include "vehicle/spec/shaft_speeds.hpp"

namespace furrow::vehicle {
namespace {

constexpr double kRpm = std::numbers::pi / 30.0;  // rad/s

Table rpm_table(const std::string& name, Points points) {
  for (auto& point : points) point.first *= kRpm;
  return Table(name, std::move(points), TableCurve::linear, TableEnd::constant);
}

}  // namespace

DriveTrain::DriveTrain(System& system, const VehicleSpec& vehicle, int chassis, std::span<const Wheel> wheels)
    : vehicle_(vehicle), spec_(vehicle.driveline) {
  FURROW_ASSERT(wheels.size() == 2 * vehicle.axles.size(), wheels.size(), vehicle.axles.size());
  add_shafts(system, chassis, wheels);
  add_drives(system);
  add_gears(system);
  add_wheels(system, wheels);
  add_motors(system, wheels);
}

int DriveTrain::shaft(const std::string& name) const {
  const int found = spec_.shaft(name);
  FURROW_ASSERT(found >= 0, name);
  return shafts_[found];
}

void DriveTrain::add_shafts(System& system, int chassis, std::span<const Wheel> wheels) {
  for (const ShaftSpec& shaft : spec_.shafts) {
    const int axle = vehicle_.axle(shaft.carrier);
    const bool turns = spec_.engine && spec_.engine->shaft == shaft.name;
    shafts_.push_back(system.add_shaft(shaft.name, shaft.inertia, axle < 0 ? chassis : wheels[2 * axle].carrier,
                                       shaft.axis.normalized(), turns ? spec_.engine->idle_rpm * kRpm : 0.0));
  }
}

void DriveTrain::add_drives(System& system) {
  if (spec_.engine) {
    const EngineSpec& e = *spec_.engine;
    engine_.emplace(system, "engine", shaft(e.shaft),
                    EngineOptions{rpm_table("engine torque", e.torque), rpm_table("engine losses", e.losses),
                                  e.idle_rpm * kRpm, e.idle_band_rpm * kRpm});
  }
  if (spec_.converter) {
    const ConverterSpec& c = *spec_.converter;
    converter_.emplace(
        system, "converter", shaft(c.in), shaft(c.out),
        ConverterOptions{Table("converter capacity", c.capacity), Table("converter torque ratio", c.torque_ratio)});
  }
  if (spec_.clutch)
    clutch_ = FrictionCoupling::clutch(system, "clutch", shaft(spec_.clutch->in), shaft(spec_.clutch->out),
                                       spec_.clutch->torque);
  if (spec_.gearbox) {
    const GearboxSpec& g = *spec_.gearbox;
    std::vector<double> ratios = g.ratios;
    if (g.reverse) ratios.push_back(*g.reverse);
    gearbox_.emplace(system, "gearbox", shaft(g.in), shaft(g.out), ratios, g.shift_time, 0);
    logic_.options = {g.up_rpm * kRpm, g.down_rpm * kRpm, g.latency};
  }
}

void DriveTrain::add_gears(System& system) {
  for (const GearSpec& gear : spec_.gears) {
    const int in = shaft(gear.in), out = shaft(gear.out);
    const Shaft &first = system.shaft(in), &second = system.shaft(out);
    if (first.carrier == second.carrier) {
      add_gear(system, gear.name, in, out, gear.ratio);
      continue;
    }
    // A shaft with joints: the absolute speeds are equal, so no torque acts on the carriers.
    const Vec3 axis = *system.pose(second.carrier).R * second.axis;
    system.add_rate_row({gear.name, {{out, 1.0}, {in, -1.0}}, {{first.carrier, second.carrier, axis, 1.0}}},
                        {.mode = RateMode::hold});
  }
  for (const DifferentialSpec& d : spec_.differentials) {
    const int first = shaft(d.outputs[0]), second = shaft(d.outputs[1]);
    add_differential(system, d.name, shaft(d.box), first, second, d.share);
    if (d.lock_torque)
      locks_.push_back(FrictionCoupling::lock(system, d.name + " lock", first, second, *d.lock_torque));
  }
}

void DriveTrain::add_wheels(System& system, std::span<const Wheel> wheels) {
  for (const WheelShaftSpec& driven : spec_.wheels) {
    const Wheel& wheel = wheels[2 * vehicle_.axle(driven.axle) + (driven.side == "left" ? kLeft : kRight)];
    const Vec3 axis = system.body(wheel.spindle).R * Vec3::UnitY();
    add_shaft_to_body(system, wheel.name + " hub", shaft(driven.shaft), wheel.spindle, axis);
  }
}

// The rotor turns in the wheel's carrier: u_rotor = gear ratio × spin of the wheel against it.
void DriveTrain::add_motors(System& system, std::span<const Wheel> wheels) {
  for (const MotorSpec& motor : spec_.motors)
    for (int side = 0; side < 2; ++side) {
      const Wheel& wheel = wheels[2 * vehicle_.axle(motor.axle) + side];
      const Vec3 axis = system.body(wheel.spindle).R * Vec3::UnitY();
      const int rotor = system.add_shaft(wheel.name + " rotor", motor.inertia, wheel.carrier, axis);
      system.add_rate_row(
          {wheel.name + " motor gear", {{rotor, -1.0}}, {{wheel.carrier, wheel.spindle, axis, motor.gear_ratio}}},
          {.mode = RateMode::hold});
      rotors_.push_back(rotor);
      motors_.emplace_back(system, wheel.name + " motor", rotor,
                           WheelMotorOptions{motor.stall_torque, motor.no_load_rpm * kRpm});
    }
}

void DriveTrain::set_inputs(System& system, const VehicleInputs& inputs) {
  FURROW_ASSERT(std::abs(inputs.throttle) <= 1.0 && std::abs(inputs.steering) <= 1.0, inputs.throttle, inputs.steering);
  FURROW_ASSERT(inputs.gear >= 0, inputs.gear);
  selector_ = inputs.selector;
  held_gear_ = inputs.gear;
  if (engine_) engine_->set_throttle(std::clamp(inputs.throttle, 0.0, 1.0));
  for (const FrictionCoupling& lock : locks_) lock.engage(system, inputs.lock ? 1.0 : 0.0);
  const double forward = selector_ == Selector::reverse ? -inputs.throttle : inputs.throttle;
  for (std::size_t k = 0; k < motors_.size(); ++k) {
    const double turn = -outward(static_cast<int>(k % 2)) * spec_.skid_steer * inputs.steering;
    motors_[k].set_command(selector_ == Selector::neutral ? 0.0 : std::clamp(forward + turn, -1.0, 1.0));
  }
}

void DriveTrain::begin_rolling(System& system, std::span<const double> spins, int gear) {
  FURROW_ASSERT(spins.size() == 2 * vehicle_.axles.size() && gear >= 0, spins.size(), gear);
  for (std::size_t k = 0; k < rotors_.size(); ++k) {
    const MotorSpec& motor = spec_.motors[k / 2];
    system.set_shaft_speed(rotors_[k], motor.gear_ratio * spins[2 * vehicle_.axle(motor.axle) + k % 2]);
  }
  if (!engine_ || spec_.wheels.empty()) return;
  double spin = 0.0;
  for (const WheelShaftSpec& wheel : spec_.wheels)
    spin += spins[2 * vehicle_.axle(wheel.axle) + (wheel.side == "left" ? kLeft : kRight)] /
            static_cast<double>(spec_.wheels.size());
  const int out = spec_.shaft(spec_.wheels.front().shaft);
  const int count = gearbox_ ? static_cast<int>(spec_.gearbox->ratios.size()) : 1;
  std::vector<double> speeds;
  for (int g = gear > 0 ? std::min(gear, count) - 1 : 0; g < count; ++g) {
    speeds = shaft_speeds(spec_, static_cast<std::size_t>(g));
    const double turns = speeds[out] != 0.0 ? spin / speeds[out] : 0.0;
    for (double& speed : speeds) speed *= turns;
    if (gearbox_) gearbox_->begin_in(system, g);
    if (gear > 0 || !gearbox_ || speeds[spec_.shaft(spec_.gearbox->in)] < spec_.gearbox->up_rpm * kRpm) break;
  }
  double& engine = speeds[spec_.shaft(spec_.engine->shaft)];
  engine = std::max(engine, spec_.engine->idle_rpm * kRpm);
  for (std::size_t k = 0; k < speeds.size(); ++k) system.set_shaft_speed(shafts_[k], speeds[k]);
}

int DriveTrain::wanted_gear(const System& system) {
  const int forward = static_cast<int>(spec_.gearbox->ratios.size()), gear = gearbox_->gear();
  if (selector_ == Selector::neutral || (selector_ == Selector::reverse && !spec_.gearbox->reverse)) return kNeutral;
  if (selector_ == Selector::reverse) return forward;
  if (held_gear_ > 0) return std::min(held_gear_, forward) - 1;
  if (gear == kNeutral || gear == forward) return 0;
  const Shaft& in = system.shaft(shaft(spec_.gearbox->in));
  return logic_.wanted(gear, forward, in.state.speed, system.time());
}

Outcome DriveTrain::advance(System& system, double h) {
  if (clutch_) {
    const double rpm = system.shaft(shaft(spec_.clutch->in)).state.speed / kRpm;
    clutch_->engage(
        system,
        std::clamp((rpm - spec_.clutch->open_rpm) / (spec_.clutch->closed_rpm - spec_.clutch->open_rpm), 0.0, 1.0));
  }
  if (!gearbox_) return {};
  if (!gearbox_->shifting())
    if (const int wanted = wanted_gear(system); wanted != gearbox_->gear())
      if (Outcome shift = gearbox_->shift(system, wanted); !shift.ok) return shift;
  return gearbox_->advance(system, h);
}

double DriveTrain::work(const System& system) const {
  double sum = engine_ ? engine_->work(system) : 0.0;
  for (const WheelMotor& motor : motors_) sum += motor.work(system);
  return sum;
}

double DriveTrain::loss(const System& system) const {
  double sum = converter_ ? converter_->heat(system) : 0.0;
  if (clutch_) sum += clutch_->heat(system);
  if (gearbox_) sum += gearbox_->loss(system);
  for (const FrictionCoupling& lock : locks_) sum += lock.heat(system);
  return sum;
}

void DriveTrain::save(Archive& archive) const {
  archive.put("selector", static_cast<std::int64_t>(selector_));
  archive.put("held_gear", static_cast<std::int64_t>(held_gear_));
  archive.put("last_shift", logic_.last_shift);
  if (engine_) engine_->save(archive);
  if (gearbox_) gearbox_->save(archive);
  for (std::size_t k = 0; k < motors_.size(); ++k) {
    Archive::Scope scope(archive, "motor" + std::to_string(k) + "/");
    motors_[k].save(archive);
  }
}

void DriveTrain::restore(const Archive& archive) {
  selector_ = static_cast<Selector>(archive.get_int("selector"));
  held_gear_ = static_cast<int>(archive.get_int("held_gear"));
  logic_.last_shift = archive.get_double("last_shift");
  if (engine_) engine_->restore(archive);
  if (gearbox_) gearbox_->restore(archive);
  for (std::size_t k = 0; k < motors_.size(); ++k) {
    Archive::Scope scope(archive, "motor" + std::to_string(k) + "/");
    motors_[k].restore(archive);
  }
}

}  // namespace furrow::vehicle
