#include "vehicle/spec/part_magnitudes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include <fmt/format.h>

#include "protocol/core/assert.hpp"
#include "protocol/core/constants.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/digits.hpp"
#include "protocol/files/json_text.hpp"

namespace furrow::vehicle {
namespace {

constexpr double kMostPartGyration = 1.5;  // radius, of the largest distance between wheels
constexpr double kLeastRate = 0.05,
                 kMostRate = 200;   // of a shock absorber: coefficient over mass, 1/s
constexpr double kMostLever = 2.0;  // of a torque, over the weight, m
constexpr double kLeastBrake = 0.002,
                 kMostBrake = 1.0;        // of one wheel's brake, over the weight, m
constexpr double kMostShaft = 0.1;        // of a shaft: inertia over mass, m²
constexpr double kMostWheelAngle = 10.0;  // camber and toe, degrees
constexpr double kLeastLock = 2.0;        // of a Pitman arm, degrees
constexpr double kMostStretch = 5.0;      // of a spring: free length over that drawn, or the inverse

using Oddities = std::vector<std::pair<std::string, std::string>>;

/// Calls call(key, part) for every struct in a part, the part itself first.
template <class T, class Call>
void each_part(const std::string& key, const T& part, const Call& call) {
  if constexpr (HasFields<T>) {
    call(key, part);
    visit_fields(part, [&](const auto& value, const Field& field) { each_part(key + "." + field.name, value, call); });
  } else if constexpr (requires { part.has_value(); }) {
    if (part) each_part(key, *part, call);
  } else if constexpr (requires { part.valueless_by_exception(); }) {
    std::visit([&](const auto& one) { each_part(key, one, call); }, part);
  }
}

/// Calls call(key of the left side, key, part) for all parts of a vehicle except its driveline.
template <class Call>
void each_part_of(const VehicleSpec& spec, const Call& call) {
  each_part("chassis", spec.chassis, [&](const std::string& key, const auto& part) { call(key, key, part); });
  for (std::size_t k = 0; k < spec.axles.size(); ++k) {
    const std::string axle = fmt::format("axles[{}].", k);
    for (const int side : {kLeft, kRight}) {
      const CornerSpec& corner = spec.axles[k].corners[side];
      const auto named = [&](const std::string& key, const auto& part) {
        call(axle + key, axle + (side == kLeft ? "" : "right.") + key, part);
      };
      each_part("suspension", corner.suspension, named);
      each_part("wheel", corner.wheel, named);
      each_part("brake", corner.brake, named);
    }
    each_part("steering", spec.axles[k].steering,
              [&](const std::string& key, const auto& part) { call(axle + key, axle + key, part); });
  }
}

class PartMagnitudes {
 public:
  PartMagnitudes(double mass, double size) : mass_(mass), size_(size) {}

  /// @param mirrored the key of the left side's part; equal oddities of the right side are reported once
  template <class T>
  void look(const std::string& mirrored, const std::string& key, const T& part) {
    mirrored_ = mirrored;
    if constexpr (requires { part.mass, part.inertia; }) body(key, part.mass, part.inertia);
    if constexpr (std::is_same_v<T, ShockSpec> || std::is_same_v<T, OuterShockSpec>) {
      damping(key, "compression", part.compression);
      damping(key, "rebound", part.rebound);
    }
    if constexpr (std::is_same_v<T, SpringSpec>)
      if (const double drawn = (part.end - part.chassis).norm();
          part.free_length > kMostStretch * drawn || part.free_length < drawn / kMostStretch)
        add(key, "free_length",
            fmt::format("is {} m, but the spring is drawn {} m long: another unit?", number_text(part.free_length),
                        digits(drawn)));
    if constexpr (std::is_same_v<T, SpindleSpec>) {
      wheel_angle(key, "camber_deg", part.camber_deg);
      wheel_angle(key, "toe_deg", part.toe_deg);
    }
    if constexpr (std::is_same_v<T, BrakeSpec>) {
      torque(key, "torque", part.torque, "one wheel's brake", kMostBrake);
      if (part.torque > 0.0 && part.torque < kLeastBrake * mass_ * kStandardGravity)
        add(key, "torque",
            fmt::format("is {} N m on a vehicle of {} kg, usual is {} N m or more: another unit?",
                        number_text(part.torque), digits(mass_), digits(kLeastBrake * mass_ * kStandardGravity)));
    }
    if constexpr (std::is_same_v<T, PitmanArmSpec>)
      if (std::abs(part.left_angle_deg) < kLeastLock)
        add(key, "left_angle_deg",
            fmt::format("is {}, and is in degrees: usual is {:g} or more in magnitude: another unit?",
                        number_text(part.left_angle_deg), kLeastLock));
  }
  void look(const DrivelineSpec& line) {
    for (std::size_t k = 0; k < line.shafts.size(); ++k)
      rotor(fmt::format("driveline.shafts[{}]", k), line.shafts[k].inertia, 1.0);
    for (std::size_t k = 0; k < line.motors.size(); ++k) {
      const MotorSpec& motor = line.motors[k];
      const std::string key = fmt::format("driveline.motors[{}]", k);
      rotor(key, motor.inertia, motor.gear_ratio);
      torque(key, "stall_torque", motor.stall_torque * std::abs(motor.gear_ratio), "with its gear_ratio one motor");
    }
  }
  Oddities take() { return std::move(odd_); }

 private:
  void add(const std::string& key, const char* name, const std::string& what) {
    const std::pair once(mirrored_ + name, what);
    if (std::find(said_.begin(), said_.end(), once) != said_.end()) return;
    said_.push_back(once);
    odd_.emplace_back(key + "." + name, what);
  }
  void body(const std::string& key, double mass, const Mat3& inertia) {
    if (key == "chassis") return;  // unlikely_values()
    if (const double gyration = std::sqrt(0.5 * inertia.trace() / mass); gyration > kMostPartGyration * size_)
      add(key, "inertia",
          fmt::format("gives a part of {} kg a radius of gyration of {} m in a vehicle of {} m: another unit?",
                      number_text(mass), digits(gyration), digits(size_)));
  }
  void damping(const std::string& key, const char* name, double c) {
    if (c == 0.0 || (c >= kLeastRate * mass_ && c <= kMostRate * mass_)) return;
    add(key, name,
        fmt::format("is {} N s/m, which alone takes about {} s to bring the whole vehicle of {} kg to rest: "
                    "another unit?",
                    number_text(c), digits(mass_ / c), digits(mass_)));
  }
  void wheel_angle(const std::string& key, const char* name, double angle) {
    if (std::abs(angle) > kMostWheelAngle)
      add(key, name,
          fmt::format("is {} degrees, usual is up to {:g} in magnitude: another unit?", number_text(angle),
                      kMostWheelAngle));
  }
  void torque(const std::string& key, const char* name, double torque, const char* who, double most = kMostLever) {
    const double weight = mass_ * kStandardGravity;
    if (torque > most * weight)
      add(key, name,
          fmt::format("gives {} N m: {} would lift the whole vehicle of {} kg on a lever of {} m: another unit?",
                      digits(torque), who, digits(mass_), digits(torque / weight)));
  }
  void rotor(const std::string& key, double inertia, double gear_ratio) {
    mirrored_ = key;
    const double at_wheel = inertia * gear_ratio * gear_ratio;
    if (at_wheel > kMostShaft * mass_)
      add(key, "inertia",
          fmt::format("is {} kg m²{} in a vehicle of {} kg, usual is up to {} kg m²: another unit?",
                      number_text(inertia),
                      gear_ratio == 1.0 ? "" : fmt::format(", at the wheel {} kg m²,", digits(at_wheel)), digits(mass_),
                      digits(kMostShaft * mass_ / (gear_ratio * gear_ratio))));
  }

  double mass_, size_;
  std::string mirrored_;
  Oddities said_, odd_;
};

}  // namespace

double size_of(const VehicleSpec& spec) {
  std::vector<Vec3> centers;
  for (const AxleSpec& axle : spec.axles)
    for (const CornerSpec& corner : axle.corners) centers.push_back(spindle_of(corner.suspension).center);
  double size = 0.0;
  for (const Vec3& a : centers)
    for (const Vec3& b : centers) size = std::max(size, (a - b).norm());
  return size;
}

std::pair<std::string, double> heaviest_body(const VehicleSpec& spec) {
  std::pair<std::string, double> heaviest;
  each_part_of(spec, [&](const std::string&, const std::string& key, const auto& part) {
    if constexpr (requires { part.mass, part.inertia; })
      if (part.mass > heaviest.second) heaviest = {key + ".mass", part.mass};
  });
  return heaviest;
}

void check_load(const VehicleSpec& spec, double mass, const std::string& tire, double most) {
  FURROW_ASSERT(mass > 0.0 && most > 0.0 && !spec.axles.empty(), mass, most);
  const std::size_t wheels = 2 * spec.axles.size();
  const double load = mass * kStandardGravity / static_cast<double>(wheels);
  if (load <= most) return;
  const auto [key, body] = heaviest_body(spec);
  throw input_error(
      spec.file, key,
      fmt::format("is {} kg: on {} wheels each tire would carry {:.3g} N, and no tire of the size of '{}' carries "
                  "{:.3g} N; expected a body of less than about {:.2g} kg",
                  number_text(body), wheels, load, tire, most, body * most / load));
}

void check_height(const VehicleSpec& spec, std::span<const double> radii) {
  FURROW_ASSERT(radii.size() == 2 * spec.axles.size(), radii.size(), spec.axles.size());
  double ground = std::numeric_limits<double>::infinity();  // the deepest of the tires, in the vehicle's frame, m
  for (std::size_t k = 0; k < radii.size(); ++k)
    ground = std::min(ground, spindle_of(spec.axles[k / 2].corners[k % 2].suspension).center.z() - radii[k]);
  const double height = spec.chassis.center_of_mass.z();
  if (!(height > ground))
    throw input_error(spec.file, "chassis.center_of_mass",
                      fmt::format("has z = {} m, expected a place above the ground, which is at z = {} m under the "
                                  "drawn wheels: z points up",
                                  number_text(height), digits(ground)));
}

Oddities unlikely_parts(const VehicleSpec& spec, double mass) {
  FURROW_ASSERT(mass > 0.0, mass);
  PartMagnitudes parts(mass, size_of(spec));
  each_part_of(spec, [&](const std::string& mirrored, const std::string& key, const auto& part) {
    parts.look(mirrored, key, part);
  });
  parts.look(spec.driveline);
  return parts.take();
}

}  // namespace furrow::vehicle
