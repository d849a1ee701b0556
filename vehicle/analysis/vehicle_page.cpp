#include "vehicle/analysis/vehicle_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <nlohmann/json.hpp>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/digits.hpp"
#include "protocol/files/figures_json.hpp"
#include "vehicle/analysis/kinematics.hpp"
#include "vehicle/analysis/tire_curve.hpp"
#include "vehicle/spec/shaft_speeds.hpp"
#include "vehicle/spec/vehicle_magnitudes.hpp"

namespace furrow::vehicle {
namespace {

constexpr double kStiffShare = 1e-3;  // of its radius, deflection of the ground under a tire that does not deflect
constexpr double kHarder = 4.0;       // factor of the ground's stiffness, for the vibrations
constexpr double kSameFrequency = 0.01;

constexpr double kDegrees = 180.0 / std::numbers::pi;

/// Reports a vehicle that cannot be built or trimmed as an error of its file.
template <class Call>
auto of_file(const VehicleSpec& spec, const Call& call) {
  try {
    return call();
  } catch (const Error& error) {
    if (error.code() != ExitCode::physics) throw;
    throw input_error(spec.file, "", error.what());
  }
}

std::vector<TireCurve> curves(std::span<const StandingTire> tires, double weight, double harder) {
  std::vector<TireCurve> made;
  for (const StandingTire& tire : tires)
    made.push_back(tire.points.empty() ? stiff_curve(tire.radius, harder * weight / static_cast<double>(tires.size()) /
                                                                      (kStiffShare * tire.radius))
                                       : tire_curve(tire.text, tire.radius, tire.points));
  return made;
}

Vec3 center_of_mass(const System& system) {
  Vec3 moment = Vec3::Zero();
  double mass = 0.0;
  for (int i = 0; i < system.body_count(); ++i) {
    moment += system.body(i).mass * system.body(i).state.position;
    mass += system.body(i).mass;
  }
  return moment / mass;
}

/// Centre of mass, wheelbase, tracks. @pre the page has its trim
void add_distances(const VehicleSpec& spec, std::span<const StandingTire> tires, VehiclePage& page) {
  Vehicle car(spec);
  for (int k = 0; k < car.wheel_count(); ++k) car.add_tire_mass(k, tires[k].mass);
  page.center_of_mass = center_of_mass(car.system()) - car.origin();
  const Mat3 R = (Eigen::AngleAxisd(page.trim.pitch, Vec3::UnitY()) * Eigen::AngleAxisd(page.trim.roll, Vec3::UnitX()))
                     .toRotationMatrix();
  page.center_height = page.trim.height + (R * page.center_of_mass).z();
  double front = -1e300, rear = 1e300, tracks = 0.0;
  for (std::size_t k = 0; k + 1 < page.trim.wheels.size(); k += 2) {
    const Vec3 &left = page.trim.wheels[k].center, &right = page.trim.wheels[k + 1].center;
    page.tracks.push_back(left.y() - right.y());
    tracks += page.tracks.back();
    front = std::max(front, 0.5 * (left.x() + right.x()));
    rear = std::min(rear, 0.5 * (left.x() + right.x()));
  }
  page.wheelbase = front - rear;
  page.static_stability_factor = tracks / static_cast<double>(page.tracks.size()) / (2.0 * page.center_height);
}

/// @param metres_per_radian that a wheel rolls per turn of engine or motor; 0 for an undriven wheel
template <class RatioOf>
void add_gear_speed(const std::string& gear, double rpm, std::size_t wheels, const RatioOf& metres_per_radian,
                    VehiclePage& page) {
  double least = 1e300;
  for (std::size_t k = 0; k < wheels; ++k)
    if (const double per_radian = std::abs(metres_per_radian(k)); per_radian > 0.0) least = std::min(least, per_radian);
  if (least < 1e300) page.gear_speeds.push_back({gear, rpm, least * rpm * std::numbers::pi / 30.0});
}

/// @pre the page has its loaded radii
void add_gear_speeds(const VehicleSpec& spec, VehiclePage& page) {
  const DrivelineSpec& line = spec.driveline;
  const auto radius_of = [&](const std::string& axle, int side) {
    const auto at = std::find(page.axles.begin(), page.axles.end(), axle) - page.axles.begin();
    return page.loaded_radii.at(2 * static_cast<std::size_t>(at) + static_cast<std::size_t>(side));
  };
  if (line.engine) {
    const double rpm = highest_speed(*line.engine).value_or(line.engine->torque.back().first);
    for (std::size_t gear = 0; gear < (line.gearbox ? line.gearbox->ratios.size() : 1U); ++gear) {
      const std::vector<double> speeds = shaft_speeds(line, gear);
      add_gear_speed(
          fmt::format("gear {}", gear + 1), rpm, line.wheels.size(),
          [&](std::size_t k) {
            const WheelShaftSpec& wheel = line.wheels[k];
            const int shaft = line.shaft(wheel.shaft);
            return shaft < 0 ? 0.0
                             : speeds[static_cast<std::size_t>(shaft)] *
                                   radius_of(wheel.axle, wheel.side == "left" ? kLeft : kRight);
          },
          page);
    }
  }
  for (const MotorSpec& motor : line.motors)
    if (page.gear_speeds.empty())
      add_gear_speed(
          "motors without load", motor.no_load_rpm, 1,
          [&](std::size_t) { return radius_of(motor.axle, kLeft) / motor.gear_ratio; }, page);
}

Trim stand(const VehicleSpec& spec, std::span<const StandingTire> tires, double harder, const ProgressCall& progress) {
  Vehicle car(spec);
  for (int k = 0; k < car.wheel_count(); ++k) car.add_tire_mass(k, tires[k].mass);
  return trim(car, curves(tires, car.mass() * car.system().gravity().norm(), harder), 0.0, {}, progress);
}

/// Refuses a trim with more wheel travel than the loaded radius: such a vehicle lies on its chassis.
void check_travel(const VehicleSpec& spec, const VehiclePage& page) {
  for (std::size_t k = 0; k < page.loaded_radii.size(); ++k) {
    const WheelTrim& wheel = page.trim.wheels[k];
    if (std::abs(wheel.travel) < page.loaded_radii[k]) continue;
    throw input_error(spec.file, fmt::format("axles[{}].suspension", k / 2),
                      fmt::format("lets the wheel '{}' stand {} m from its drawn place, expected springs that carry "
                                  "the vehicle",
                                  wheel.name, digits(wheel.travel)));
  }
}

/// The vibrations that do not change on harder ground, lowest first.
std::vector<TrimMode> lasting(const std::vector<TrimMode>& modes, const std::vector<TrimMode>& harder) {
  std::vector<TrimMode> kept;
  for (std::size_t k = 0; k < std::min(modes.size(), harder.size()); ++k)
    if (std::abs(harder[k].frequency - modes[k].frequency) <= kSameFrequency * modes[k].frequency)
      kept.push_back(harder[k]);
  return kept;
}

}  // namespace

double mass_without_tires(const VehicleSpec& spec) {
  return of_file(spec, [&] { return Vehicle(spec).mass(); });
}

VehiclePage vehicle_page(const VehicleSpec& spec, std::span<const StandingTire> tires, const ProgressCall& progress) {
  FURROW_ASSERT(tires.size() == 2 * spec.axles.size(), tires.size(), spec.axles.size());
  return of_file(spec, [&] {
    const Vehicle car(spec);
    const System& system = car.system();
    VehiclePage page;
    page.name = spec.name;
    page.file = spec.file;
    page.mass = car.mass();
    page.bodies = system.body_count();
    page.rows = system.constraint_count();
    page.freedoms = 6 * page.bodies - page.rows + system.redundant_count();
    page.shafts = system.shaft_count();
    page.shaft_freedoms = car.freedoms() - page.freedoms;
    for (const AxleSpec& axle : spec.axles) page.axles.push_back(axle.name);
    for (const StandingTire& tire : tires) page.tires.push_back(tire.text), page.tire_masses.push_back(tire.mass.mass);
    page.trim = stand(spec, tires, 1.0, progress);
    if (std::any_of(tires.begin(), tires.end(), [](const StandingTire& t) { return t.points.empty(); }))
      page.trim.modes = lasting(page.trim.modes, stand(spec, tires, kHarder, progress).modes);
    for (std::size_t k = 0; k < tires.size(); ++k)
      page.loaded_radii.push_back(tires[k].radius - std::max(0.0, page.trim.wheels[k].deflection));
    check_travel(spec, page);
    check_locks(spec, page.loaded_radii, progress);
    page.full_steering = full_steering(spec, page.loaded_radii);
    std::vector<double> travel;
    for (const WheelTrim& wheel : page.trim.wheels) travel.push_back(wheel.travel);
    page.damping_ratios = damping_ratios(spec, page.loaded_radii, travel);
    add_distances(spec, tires, page);
    add_gear_speeds(spec, page);
    return page;
  });
}

std::vector<std::pair<std::string, std::string>> steers_against(const VehicleSpec& spec, const VehiclePage& page) {
  std::vector<std::pair<std::string, std::string>> odd;
  for (std::size_t k = 0; k < page.axles.size(); ++k) {
    const double angle = page.full_steering[k];
    if (!(angle < 0.0) || page.trim.wheels[2 * k].center.x() < page.center_of_mass.x()) continue;
    odd.emplace_back(fmt::format("axles[{}].steering.{}", k, end_key(*spec.axles[k].steering)),
                     fmt::format("turns the wheels {} degrees to the right at full steering to the left: the other "
                                 "sign?",
                                 digits(-kDegrees * angle)));
  }
  return odd;
}

nlohmann::ordered_json page_json(const VehiclePage& page) {
  nlohmann::ordered_json json = figures_json(page);
  // The trim's members are at the same level as the vehicle's.
  const nlohmann::ordered_json trim = json["trim"];
  json.erase("trim");
  json.update(trim);
  return json;
}

namespace {

/// A number with these digits, without a minus sign before zeros.
std::string fixed(double value, int digits) {
  const double unit = std::pow(10.0, -digits);
  return fmt::format("{:.{}f}", std::abs(value) < 0.5 * unit ? 0.0 : value, digits);
}

std::string tires_text(const VehiclePage& page) {
  std::string text;
  for (std::size_t k = 0; k < page.tires.size(); ++k) {
    // Wheels of the same tire share a line.
    if (std::find(page.tires.begin(), page.tires.begin() + static_cast<long>(k), page.tires[k]) !=
        page.tires.begin() + static_cast<long>(k))
      continue;
    const auto count = std::count(page.tires.begin(), page.tires.end(), page.tires[k]);
    text += fmt::format("{:<12} {} × {}, {:.2f} kg each\n", "tires", count, page.tires[k], page.tire_masses[k]);
  }
  return text;
}

std::string loads_text(const VehiclePage& page) {
  double sum = 0.0;
  for (const double load : page.trim.axle_loads) sum += load;
  std::string text;
  for (std::size_t k = 0; k < page.axles.size(); ++k)
    text += fmt::format("{}{} {:.0f} N ({:.1f} %)", k > 0 ? ", " : "", page.axles[k], page.trim.axle_loads[k],
                        100.0 * page.trim.axle_loads[k] / sum);
  return text;
}

std::string tracks_text(const VehiclePage& page) {
  std::string text;
  for (std::size_t k = 0; k < page.axles.size(); ++k)
    text += fmt::format("{}{} {} m", k > 0 ? ", " : "", page.axles[k], fixed(page.tracks[k], 3));
  return text;
}

std::string steering_text(const VehiclePage& page) {
  std::string text;
  for (std::size_t k = 0; k < page.axles.size(); ++k)
    if (const double angle = page.full_steering[k]; angle != 0.0)
      text += fmt::format("{}{} {}° {}", text.empty() ? "" : ", ", page.axles[k], fixed(kDegrees * std::abs(angle), 1),
                          angle > 0.0 ? "left" : "right");
  return text;
}

std::string gears_text(const VehiclePage& page) {
  std::string text;
  for (const GearSpeed& gear : page.gear_speeds)
    text += fmt::format("{}{} {} m/s", text.empty() ? "" : ", ", gear.gear, digits(gear.speed));
  return fmt::format("{}, at {:.0f} rpm without slip", text, page.gear_speeds.front().engine_rpm);
}

std::string wheels_text(const VehiclePage& page) {
  constexpr const char* kRow = "{:<14} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8}\n";
  std::string text = fmt::format(kRow, "wheel", "load", "tire", "centre", "travel", "camber", "toe", "damping");
  text += fmt::format(kRow, "", "N", "mm", "mm", "mm", "°", "°", "%");
  for (std::size_t k = 0; k < page.trim.wheels.size(); ++k) {
    const WheelTrim& w = page.trim.wheels[k];
    const double damping = page.damping_ratios[k];
    text += fmt::format(kRow, w.name, fixed(w.load, 0), fixed(1e3 * w.deflection, 1), fixed(1e3 * w.height, 1),
                        fixed(1e3 * w.travel, 1), fixed(kDegrees * w.camber, 2), fixed(kDegrees * w.toe, 2),
                        std::isnan(damping) ? "none" : fixed(100.0 * damping, 0));
  }
  return text;
}

std::string struts_text(const Trim& trim) {
  constexpr const char* kRow = "{:<22} {:>8} {:>8} {:>12} {:>12}\n";
  const auto room = [](double to_end) { return std::isfinite(to_end) ? fixed(1e3 * to_end, 1) : std::string("none"); };
  std::string text;
  for (const WheelTrim& w : trim.wheels)
    for (const auto& [kind, strut] : {std::pair{"spring", w.spring}, std::pair{"shock", w.shock}})
      if (strut)
        text += fmt::format(kRow, w.name + ", " + kind, fixed(1e3 * strut->length, 1), fixed(strut->force, 0),
                            room(strut->to_shortest), room(strut->to_longest));
  if (text.empty()) return "";
  return fmt::format(kRow, "strut", "length", "push", "to shortest", "to longest") +
         fmt::format(kRow, "", "mm", "N", "mm", "mm") + text + "\n";
}

std::string modes_text(const Trim& trim) {
  std::string text = fmt::format("{:<14} {:>8} {:>8}\n{:<14} {:>8} {:>8}\n", "vibration", "Hz", "damping", "", "", "%");
  for (const TrimMode& mode : trim.modes)
    text += fmt::format("{:<14} {:>8.2f} {:>8.0f}\n", mode.name, mode.frequency, 100.0 * mode.damping);
  return text;
}

}  // namespace

std::string page_text(const VehiclePage& page) {
  double mass = page.mass;
  for (const double tire : page.tire_masses) mass += tire;
  std::string text;
  const auto line = [&](const char* name, const std::string& value) {
    text += fmt::format("{:<12} {}\n", name, value);
  };
  line("vehicle", fmt::format("{} ({})", page.name, page.file));
  line("mass", fmt::format("{:.2f} kg, with its tires {:.2f} kg", page.mass, mass));
  line("bodies", fmt::format("{}, {} rows, {} degrees of freedom", page.bodies, page.rows, page.freedoms));
  if (page.shafts > 0)
    line("shafts", fmt::format("{}, {} more degree{} of freedom", page.shafts, page.shaft_freedoms,
                               page.shaft_freedoms == 1 ? "" : "s"));
  text += tires_text(page);
  line("stands", fmt::format("origin {} mm above the ground, nose {}° down, right side {}° down",
                             fixed(1e3 * page.trim.height, 1), fixed(kDegrees * page.trim.pitch, 2),
                             fixed(kDegrees * page.trim.roll, 2)));
  line("axle loads", loads_text(page));
  line("centre",
       fmt::format("of mass x {} m, y {} m, z {} m, {} m above the ground", fixed(page.center_of_mass.x(), 3),
                   fixed(page.center_of_mass.y(), 3), fixed(page.center_of_mass.z(), 3), fixed(page.center_height, 3)));
  if (page.axles.size() > 1) line("wheelbase", fixed(page.wheelbase, 3) + " m");
  line("track", tracks_text(page));
  line("stability", fmt::format("static stability factor {}", fixed(page.static_stability_factor, 2)));
  if (!page.gear_speeds.empty()) line("speeds", gears_text(page));
  if (const std::string steered = steering_text(page); !steered.empty())
    line("steering", "full left turns the wheels of " + steered);
  return text + "\n" + wheels_text(page) + "\n" + struts_text(page.trim) + modes_text(page.trim);
}

}  // namespace furrow::vehicle
