#include "vehicle/analysis/trim.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <fmt/format.h>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/digits.hpp"
#include "vehicle/analysis/held_vehicle.hpp"
#include "vehicle/analysis/wheel_angles.hpp"

namespace furrow::vehicle {
namespace {

// Force of an axle's springs over the weight: outside these limits they do not carry a vehicle.
constexpr double kLeastPush = 0.03, kMostPush = 20.0;
constexpr double kFirstDeflection = 0.01;  // of the tires at the start of the search, m

struct Contact {
  double deflection = 0.0, load = 0.0;  // m, N
  Vec3 moment = Vec3::Zero();           // about the wheel's centre, N m
};

// V = ∫ F dδ: upward force F/cos γ, moment F z_c a_z (a × e_z) / cos³γ.
Contact contact(const Vehicle& vehicle, int k, const TireCurve& tire, double ground) {
  const Vec3 a = spin_axis(vehicle, k);
  const double cosine = std::sqrt(1.0 - a.z() * a.z());
  const double z = vehicle.system().body(vehicle.wheel(k).spindle).state.position.z() - ground;
  Contact c;
  c.deflection = tire.radius - z / cosine;
  const double force = tire.force(c.deflection);
  c.load = force / cosine;
  c.moment = force * z * a.z() / (cosine * cosine * cosine) * a.cross(Vec3::UnitZ());
  return c;
}

void hold_plane_motion(const Vehicle& vehicle, Statics& statics) {
  const System& system = vehicle.system();
  const int chassis = vehicle.chassis();
  statics.hold({"chassis x", offset_row(system, kGround, chassis, Vec3::UnitX())});
  statics.hold({"chassis y", offset_row(system, kGround, chassis, Vec3::UnitY())});
  Row yaw;
  yaw.kind = RowKind::dot;
  yaw.b = chassis;
  yaw.axis_a = Vec3::UnitY();
  yaw.axis_b = Vec3::UnitX();
  statics.hold({"chassis yaw", yaw});
  hold_spins(vehicle, statics);
}

void lower_to(Vehicle& vehicle, std::span<const TireCurve> tires, double ground) {
  double above = 0.0;
  for (int k = 0; k < vehicle.wheel_count(); ++k)
    above += (vehicle.rim(k).position.z() - tires[k].radius) / vehicle.wheel_count();
  vehicle.move(Vec3(0, 0, ground - kFirstDeflection - above));
}

StrutTrim strut(const System& system, int element) {
  const ForceElement& e = system.element(element);
  StrutTrim s;
  s.length = row_value(system, e.row);
  s.force = e.law(s.length, 0.0, system.time()).force;
  s.to_shortest = s.to_longest = std::numeric_limits<double>::infinity();
  return s;
}

template <class Marks>
void set_marks(StrutTrim& s, const std::optional<Marks>& marks) {
  if (!marks) return;
  s.to_shortest = s.length - marks->shortest;
  s.to_longest = marks->longest - s.length;
}

WheelTrim wheel_trim(const Vehicle& vehicle, int k, const TireCurve& tire, double ground) {
  const Wheel& wheel = vehicle.wheel(k);
  const System& system = vehicle.system();
  const Body& chassis = system.body(vehicle.chassis());
  const Contact touching = contact(vehicle, k, tire, ground);
  const Vec3 center = system.body(wheel.spindle).state.position, axis = spin_axis(vehicle, k);
  WheelTrim t;
  t.name = wheel.name;
  t.load = touching.load;
  t.deflection = touching.deflection;
  t.height = center.z() - ground;
  t.center = chassis.R.transpose() * (center - vehicle.origin());
  t.travel = t.center.z() - spindle_of(wheel.corner->suspension).center.z();
  t.camber = camber_angle(axis, outward(wheel.side));
  t.toe = toe_angle(axis, outward(wheel.side));
  std::visit(
      [&](const auto& s) {
        if constexpr (requires { s.spring; }) {
          if (wheel.spring) set_marks(t.spring.emplace(strut(system, *wheel.spring)), s.spring->stop);
          if (wheel.shock) set_marks(t.shock.emplace(strut(system, *wheel.shock)), s.shock->outer);
        }
      },
      wheel.corner->suspension);
  return t;
}

/// Kinetic energy of a body in a mode, split into heave, pitch, roll and the rest.
struct Shares {
  double heave = 0.0, pitch = 0.0, roll = 0.0, all = 0.0;
};
Shares shares(const Body& body, const Eigen::VectorXd& shape, int index) {
  const Vec3 v = shape.segment<3>(6 * index), w = body.R.transpose() * shape.segment<3>(6 * index + 3);
  Shares s;
  s.heave = body.mass * v.z() * v.z();
  s.roll = body.inertia(0, 0) * w.x() * w.x();
  s.pitch = body.inertia(1, 1) * w.y() * w.y();
  s.all = body.mass * v.squaredNorm() + w.dot(body.inertia * w);
  return s;
}

/// @param taken names of lower modes. If two vibrations move the same axle most, the second is named after the axle
/// that it moves second most
std::string mode_name(const Vehicle& vehicle, const Mode& mode, const std::vector<TrimMode>& taken) {
  const System& system = vehicle.system();
  const Shares body = shares(system.body(vehicle.chassis()), mode.shape, vehicle.chassis());
  if (body.all > 0.5) {
    if (body.roll >= body.heave && body.roll >= body.pitch) return "roll";
    return body.heave >= body.pitch ? "heave" : "pitch";
  }
  const auto up = [&](int k) { return mode.shape[6 * vehicle.wheel(k).spindle + 2]; };
  std::vector<std::pair<double, int>> axles;  // −energy, left wheel
  for (int k = 0; k < vehicle.wheel_count(); k += 2) axles.emplace_back(-up(k) * up(k) - up(k + 1) * up(k + 1), k);
  std::sort(axles.begin(), axles.end());
  std::string first;
  for (const auto& [energy, k] : axles) {
    const std::string name =
        (up(k) * up(k + 1) >= 0.0 ? "hop " : "tramp ") + vehicle.spec().axles[static_cast<std::size_t>(k) / 2].name;
    if (first.empty()) first = name;
    if (std::none_of(taken.begin(), taken.end(), [&](const TrimMode& mode) { return mode.name == name; })) return name;
  }
  return first;
}

/// A fault of the drawn vehicle that may prevent its rest, for the end of that message; empty if none is found.
std::string fault_as_drawn(const Vehicle& vehicle, double weight) {
  const System& system = vehicle.system();
  Vec3 center = Vec3::Zero(), low = Vec3::Constant(1e300), high = -low;
  for (int i = 0; i < system.body_count(); ++i)
    center += system.body(i).mass * system.body(i).state.position / vehicle.mass();
  for (int k = 0; k < vehicle.wheel_count(); ++k)
    low = low.cwiseMin(vehicle.rim(k).position), high = high.cwiseMax(vehicle.rim(k).position);
  if ((center.head<2>().array() < low.head<2>().array()).any() ||
      (center.head<2>().array() > high.head<2>().array()).any())
    return fmt::format("; its centre of mass, x = {:.2f} m, y = {:.2f} m, does not lie between its wheels",
                       center.x() - vehicle.origin().x(), center.y() - vehicle.origin().y());
  for (int axle = 0; axle < vehicle.wheel_count() / 2; ++axle) {
    double push = 0.0;
    for (const int k : {2 * axle, 2 * axle + 1})
      if (vehicle.wheel(k).spring) {
        const ForceElement& spring = system.element(*vehicle.wheel(k).spring);
        push += spring.law(row_value(system, spring.row), 0.0, 0.0).force;
      }
    if (vehicle.wheel(2 * axle).spring && (push < kLeastPush * weight || push > kMostPush * weight))
      return fmt::format("; it weighs {:.0f} N, and the springs of axle '{}' push with {:.3g} N as drawn", weight,
                         vehicle.spec().axles[axle].name, push);
  }
  return "";
}

}  // namespace

Trim trim(Vehicle& vehicle, std::span<const TireCurve> tires, double ground, const std::optional<Vec3>& gravity,
          const ProgressCall& progress) {
  FURROW_ASSERT(tires.size() == static_cast<std::size_t>(vehicle.wheel_count()), tires.size(), vehicle.wheel_count());
  lower_to(vehicle, tires, ground);
  Statics statics(vehicle.system());
  hold_plane_motion(vehicle, statics);
  const Vec3 own = vehicle.system().gravity(), felt = gravity.value_or(own);
  const Vec3 held = Vec3(-felt.x(), -felt.y(), 0.0) * vehicle.mass() / vehicle.wheel_count();
  statics.set_forces([&](const System& system, Eigen::VectorXd& forces) {
    for (int k = 0; k < vehicle.wheel_count(); ++k) {
      const int spindle = vehicle.wheel(k).spindle;
      const Contact touching = contact(vehicle, k, tires[k], ground);
      const double z = system.body(spindle).state.position.z() - ground;
      forces[6 * spindle + 2] += touching.load;
      forces.segment<3>(6 * spindle) += held;
      forces.segment<3>(6 * spindle + 3) += touching.moment + Vec3(z * held.y(), -z * held.x(), 0.0);
    }
    for (int i = 0; i < system.body_count(); ++i) forces.segment<3>(6 * i) += system.body(i).mass * (felt - own);
  });
  const double weight = vehicle.mass() * vehicle.system().gravity().norm();
  const std::string fault = fault_as_drawn(vehicle, weight);
  if (const Outcome outcome = statics.settle(weight, progress); !outcome.ok)
    throw physics_error(outcome.message("vehicle '" + vehicle.spec().name + "'") + fault);
  Trim t;
  for (int k = 0; k < vehicle.wheel_count(); ++k) {
    t.wheels.push_back(wheel_trim(vehicle, k, tires[k], ground));
    if (k % 2 == 0) t.axle_loads.push_back(0.0);
    t.axle_loads.back() += t.wheels.back().load;
  }
  const Mat3& R = vehicle.system().body(vehicle.chassis()).R;
  t.height = vehicle.origin().z() - ground;
  t.pitch = std::atan2(-R(2, 0), R(0, 0));
  t.roll = std::atan2(R(2, 1), R(2, 2));
  for (const Mode& mode : statics.modes())
    t.modes.push_back({mode_name(vehicle, mode, t.modes), mode.frequency, mode.damping});
  vehicle.system().assemble(vehicle.system().time());
  return t;
}

std::vector<std::pair<std::string, std::string>> stops_at_rest(const VehicleSpec& spec, const Trim& trim) {
  FURROW_ASSERT(trim.wheels.size() == 2 * spec.axles.size(), trim.wheels.size(), spec.axles.size());
  std::vector<std::pair<std::string, std::string>> found;
  for (std::size_t k = 0; k < trim.wheels.size(); ++k) {
    const WheelTrim& wheel = trim.wheels[k];
    const std::string key = fmt::format("axles[{}].suspension.spring.stop", k / 2);
    if (!wheel.spring || (!found.empty() && found.back().first == key)) continue;
    const StrutTrim& s = *wheel.spring;
    const bool pressed = s.to_shortest < 0.0;
    if (!pressed && !(s.to_longest < 0.0)) continue;
    found.emplace_back(
        key, fmt::format("holds the wheel '{}' at rest: its spring is {} mm long, {} mm beyond {}, and pushes with "
                         "{} N: a {} spring leaves it travel",
                         wheel.name, digits(1e3 * s.length), digits(-1e3 * (pressed ? s.to_shortest : s.to_longest)),
                         pressed ? "shortest" : "longest", digits(s.force),
                         pressed ? "stiffer or longer" : "softer or shorter"));
  }
  return found;
}

}  // namespace furrow::vehicle
