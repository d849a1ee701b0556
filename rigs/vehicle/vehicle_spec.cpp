#include "rigs/vehicle/vehicle_spec.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/data_files.hpp"
#include "protocol/files/json_fields.hpp"
#include "protocol/files/json_text.hpp"
#include "rigs/lowering.hpp"
#include "rigs/section_keys.hpp"
#include "rigs/vehicle/vehicle_rig.hpp"
#include "rigs/vehicle/vehicle_start.hpp"
#include "vehicle/analysis/kinematics.hpp"
#include "vehicle/driver/driver_car.hpp"
#include "vehicle/driver/path_shapes.hpp"
#include "vehicle/driver/read_driver.hpp"
#include "vehicle/driver/speed_control.hpp"
#include "vehicle/driver/write_driver.hpp"
#include "vehicle/spec/part_magnitudes.hpp"
#include "vehicle/spec/read_vehicle.hpp"
#include "vehicle/spec/vehicle_magnitudes.hpp"

namespace furrow::rigs {
namespace {

using nlohmann::json;

constexpr double kFarFromPath = 3.0;  // in wheelbases; warns if the path is farther from the rear axle
constexpr double kBendLength = 0.25;  // in wheelbases; a path's curvature is computed over this length
constexpr double kTooTight = 1.02;    // warns if the path is this much tighter than the vehicle's tightest curve
constexpr int kPlacesOfPiece = 8;     // of a path's piece, at which its curvature is computed

std::filesystem::path vehicle_file(const json& section, const ReadContext& context) {
  if (!says(section, "vehicle"))
    throw input_error(context.file, context.key("vehicle"),
                      "is missing, expected the name of a vehicle's file: hmmwv.json");
  return find_file(section["vehicle"].get<std::string>(), context.key("vehicle"), context.file);
}

/// Joins axle and side to one word for keys and labels: "front_left".
std::string wheel_name(const vehicle::VehicleSpec& vehicle, std::size_t wheel) {
  std::string name = vehicle.axles[wheel / 2].name + "_" + vehicle::kSideNames[wheel % 2];
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
}

/// Reads a driver's file, or its content within the scenario, which may omit its version.
std::optional<vehicle::DriverSpec> read_driver_of(const json& driver, const ReadContext& context) {
  const std::string key = context.key("driver");
  if (driver.is_null()) return std::nullopt;
  if (driver.is_string()) return vehicle::read_driver(find_file(driver.get<std::string>(), key, context.file));
  json document = driver;
  if (!document.contains("format_version")) document["format_version"] = 1;
  return vehicle::read_driver(document, context.file, key);
}

class VehicleRigSpec final : public RigSpec {
 public:
  VehicleRigSpec(VehicleRigPlan plan, std::filesystem::path file, ReadContext context)
      : plan_(std::move(plan)), file_(std::move(file)), context_(std::move(context)) {
    check_driver();
    attempt([&] {
      const vehicle::Vehicle car(plan_.vehicle, plan_.gravity);
      bodies_ = car.system().body_count();
      mass_ = car.mass();
      for (int k = 0; k < car.wheel_count(); ++k) {
        wheels_.emplace_back();
        const vehicle::CornerSpec& corner = *car.wheel(k).corner;
        const vehicle::SpindleSpec& spindle = vehicle::spindle_of(corner.suspension);
        wheels_.back().center = spindle.center;
        wheels_.back().turning_mass = corner.wheel.mass + spindle.mass;
        wheels_.back().spin_inertia = corner.wheel.inertia(1, 1) + spindle.inertia(1, 1);
      }
    });
  }

  std::size_t wheel_count() const override { return wheels_.size(); }
  void mount(std::span<const MountedTire> tires) override;
  RigDescription describe(std::span<const WheelSize> tires, double duration) const override;
  std::unique_ptr<Rig> make() const override { return make_vehicle_rig(plan_); }
  void fill_starts(std::span<const WheelSize> tires, double duration, std::optional<double> length,
                   std::span<const double> margins) override;
  std::vector<RigFile> files() const override { return {{"vehicle", file_}}; }
  Vec3 gravity() const override { return plan_.gravity; }
  double stop_before_wall() const override { return std::max(0.0, plan_.options.stop_before_wall); }
  void complete(json& section) const override;
  std::vector<std::pair<std::string, std::string>> unlikely_values() const override;

  bool start_given = true;
  bool drops = false;  // rig.drop_height is above zero

 private:
  struct WheelPlace {
    Vec3 center = Vec3::Zero();  // in the vehicle's frame, m
    double load = 0.0;           // at rest, N
    double camber = 0.0, toe = 0.0;
    double tire_mass = 0.0;     // kg
    double turning_mass = 0.0;  // rim, hub and what turns with them, kg
    double spin_inertia = 0.0;  // of these parts, kg m²
  };

  /// Reports a failure of `work` as an error in the vehicle's file. @throws Error(bad_input)
  template <class Work>
  void attempt(const Work& work) const {
    try {
      work();
    } catch (const Error& error) {
      throw input_error(context_.file, context_.key("vehicle"),
                        fmt::format("is {}, which cannot be used: {}", file_.string(), error.what()));
    }
  }
  void check_driver() const;
  std::vector<std::string> oddities_of_path() const;
  void check_gears() const;
  Vec3 place_of(std::size_t wheel) const;
  double travel(double duration) const;
  double top_speed() const;
  bool steers() const;
  WheelDescription wheel(std::size_t k, const WheelSize& tire, double duration) const;

  VehicleRigPlan plan_;
  std::filesystem::path file_;
  ReadContext context_;
  std::vector<WheelPlace> wheels_;
  int bodies_ = 0;
  double mass_ = 0.0;                                       // without tires, kg
  std::vector<std::pair<std::string, std::string>> stops_;  // stops on which springs rest
  std::optional<double> length_;                            // of the bin, m
  double duration_ = 0.0;                                   // of the run, s
  vehicle::DriverCar driven_;                               // the driver's data of the vehicle, if there is a driver
};

void VehicleRigSpec::check_gears() const {
  const std::string& name = plan_.vehicle.name;
  const auto& gearbox = plan_.vehicle.driveline.gearbox;
  const int gears = gearbox ? static_cast<int>(gearbox->ratios.size()) : 1;
  for (const auto& [time, gear] : plan_.driver->inputs.gear) {
    const bool backward = gearbox ? gearbox->reverse.has_value() : !plan_.vehicle.driveline.motors.empty();
    if (gear == vehicle::gear_request::reverse && !backward)
      throw input_error(
          context_.file, context_.key("driver"),
          fmt::format("asks for gear -1 at {} s, expected 0 to {} or 'auto': the vehicle {} has {}", number_text(time),
                      gears, name,
                      gearbox ? "no reverse gear" : "neither a gearbox nor motors, which turn backward in it"));
    if (gear == vehicle::gear_request::reverse && plan_.driver->speed)
      throw input_error(
          context_.file, context_.key("driver"),
          fmt::format("holds a speed and asks for gear -1 at {} s, expected one of them: the speed is that forward",
                      number_text(time)));
    if (gear > gears)
      throw input_error(
          context_.file, context_.key("driver"),
          fmt::format("asks for gear {} at {} s, expected at most {}: the vehicle {} has {}", number_text(gear),
                      number_text(time), gears, name, gearbox ? "no more" : "no gearbox"));
  }
}

void VehicleRigSpec::check_driver() const {
  if (!plan_.driver) return;
  check_gears();
  const auto refuse = [&](const char* what, const char* lacks) {
    throw input_error(
        context_.file, context_.key("driver"),
        fmt::format("{}, expected a driver that does not: the vehicle {} has {}", what, plan_.vehicle.name, lacks));
  };
  if (plan_.driver->path && !vehicle::can_steer(plan_.vehicle)) refuse("follows a path", "no steering");
  if (plan_.driver->path && !vehicle::can_follow(plan_.vehicle))
    refuse("follows a path", "no steered axle ahead of its last one");
  if (plan_.driver->speed && !vehicle::can_drive(plan_.vehicle)) refuse("holds a speed", "neither engine nor motors");
  const vehicle::InputSpec& inputs = plan_.driver->inputs;
  const auto refuse_use = [&](const char* what, const vehicle::DriverPoints& points, const char* lacks) {
    const auto used = std::find_if(points.begin(), points.end(), [](const auto& point) { return point.second != 0.0; });
    if (used == points.end()) return;
    refuse(fmt::format("gives {} {} at {} s", what, number_text(used->second), number_text(used->first)).c_str(),
           lacks);
  };
  if (!vehicle::can_steer(plan_.vehicle)) refuse_use("steering", inputs.steering, "no steering");
  if (!vehicle::can_drive(plan_.vehicle)) refuse_use("throttle", inputs.throttle, "neither engine nor motors");
  if (!vehicle::can_brake(plan_.vehicle)) refuse_use("brake", inputs.brake, "no brakes");
  if (!inputs.lock.empty() && !vehicle::can_lock(plan_.vehicle))
    refuse("gives lock", "no differential with a lock_torque");
}

/// Computes the trim, which needs the tires' masses.
void VehicleRigSpec::mount(std::span<const MountedTire> tires) {
  FURROW_ASSERT(tires.size() == wheels_.size(), tires.size(), wheels_.size());
  std::vector<double> radii;
  double mass = 0.0, largest = 0.0;
  for (const MountedTire& tire : tires) {
    radii.push_back(tire.radius);
    largest = std::max(largest, tire.radius);
    plan_.tire_width = std::max(plan_.tire_width, tire.width);
  }
  attempt([&] {
    vehicle::check_height(plan_.vehicle, radii);
    vehicle::Vehicle car(plan_.vehicle, plan_.gravity);
    for (std::size_t k = 0; k < tires.size(); ++k)
      car.add_tire_mass(static_cast<int>(k), {tires[k].mass, Mat3::Zero()});
    car.system().assemble(0.0);
    mass = car.mass();
    for (const MountedTire& tire : tires)
      vehicle::check_load(plan_.vehicle, mass, std::filesystem::path(tire.file).filename().string(),
                          tire.hopeless_load);
    const vehicle::Trim trim = stand(car, radii, plan_.options.heading);
    for (std::size_t k = 0; k < tires.size(); ++k) {
      const vehicle::WheelTrim& at = trim.wheels[k];
      wheels_[k] = {
          at.center, at.load, at.camber, at.toe, tires[k].mass, wheels_[k].turning_mass, wheels_[k].spin_inertia};
    }
    stops_ = vehicle::stops_at_rest(plan_.vehicle, trim);
    vehicle::check_locks(plan_.vehicle, radii);
    if (plan_.driver) driven_ = vehicle::driver_car(plan_.vehicle, radii, plan_.tire_width, mass);
  });
  const double g = plan_.gravity.norm();
  VehicleRigOptions& o = plan_.options;
  if (o.lowering_speed < 0.0) o.lowering_speed = drops ? 0.0 : kLoweringFroude * std::sqrt(g * largest);
  if (o.touchdown_time < 0.0) o.touchdown_time = kLoweringTime * std::sqrt(largest / g);
  if (o.stop_before_wall < 0.0) o.stop_before_wall = largest;
}

/// Place of a wheel relative to the vehicle's origin, W, m.
Vec3 VehicleRigSpec::place_of(std::size_t k) const {
  return Eigen::AngleAxisd(plan_.options.heading, Vec3::UnitZ()) * wheels_.at(k).center;
}

/// Largest distance that a driver covers who holds speeds and goes straight, m; 0 for other drivers.
double VehicleRigSpec::travel(double duration) const {
  if (!plan_.driver || !plan_.driver->speed || steers()) return 0.0;
  const vehicle::Table target = vehicle::table_of_time("target", plan_.driver->speed->target);
  constexpr int kParts = 1000;
  double way = 0.0;
  for (int i = 0; i < kParts; ++i) way += target.value((i + 0.5) * duration / kParts) * duration / kParts;
  return way;
}

double VehicleRigSpec::top_speed() const {
  double most = plan_.options.start_speed;
  if (plan_.driver && plan_.driver->speed)
    for (const auto& [time, speed] : plan_.driver->speed->target) most = std::max(most, speed);
  return most;
}

bool VehicleRigSpec::steers() const {
  if (!plan_.driver) return false;
  const vehicle::DriverPoints& points = plan_.driver->inputs.steering;
  return plan_.driver->path ||
         std::any_of(points.begin(), points.end(), [](const auto& point) { return point.second != 0.0; });
}

WheelDescription VehicleRigSpec::wheel(std::size_t k, const WheelSize& tire, double duration) const {
  const WheelPlace& place = wheels_[k];
  const Vec3 at = place_of(k);
  const double psi = plan_.options.heading;
  const bool steered = steers() && plan_.vehicle.axles[k / 2].steering;
  const double angle = std::abs(psi) + (steered ? driven_.steering_lock : std::abs(place.toe));
  WheelDescription d;
  d.name = wheel_name(plan_.vehicle, k);
  d.lateral = plan_.options.lateral + at.y();
  d.from = plan_.options.start + at.x();
  d.to = d.from + std::cos(psi) * travel(duration);
  const double s = std::abs(std::sin(angle)), half = 0.5 * tire.width;
  d.along = tire.radius + tire.beyond + half * s;
  d.across = half + (tire.radius + tire.beyond) * s;
  if (length_ && stop_before_wall() > 0.0) {
    const double reach = d.along + stop_before_wall();
    const double last = d.to >= d.from ? std::max(d.from, *length_ - reach) : std::min(d.from, reach);
    d.stops_before_wall = std::abs(d.to - d.from) > std::abs(last - d.from);
    if (d.stops_before_wall) d.to = last;
  }
  d.toe_angle = steered ? driven_.steering_lock : place.toe;
  d.camber_angle = place.camber;
  d.travel_sign = std::cos(psi) < 0.0 ? -1.0 : 1.0;
  d.carried_mass = std::max(0.0, -place.load / plan_.gravity.z() - place.tire_mass);
  d.unsprung_mass = place.turning_mass;
  d.spin_inertia = place.spin_inertia;
  d.speed = d.tread_speed = top_speed();
  d.start_key = context_.key("start");
  d.start_offset = at.x();
  return d;
}

RigDescription VehicleRigSpec::describe(std::span<const WheelSize> tires, double duration) const {
  FURROW_ASSERT(tires.size() == wheels_.size(), tires.size(), wheels_.size());
  RigDescription d;
  d.kind = "vehicle";
  d.text = fmt::format("vehicle {} on {} wheels, {} bodies, {}", plan_.vehicle.name, wheels_.size(), bodies_,
                       plan_.driver ? "with a driver" : "parked");
  d.speeds_up_key = context_.key("driver");
  for (std::size_t k = 0; k < wheels_.size(); ++k) d.wheels.push_back(wheel(k, tires[k], duration));
  return d;
}

std::vector<std::pair<std::string, std::string>> VehicleRigSpec::unlikely_values() const {
  std::vector<std::pair<std::string, std::string>> odd;
  auto of_file = vehicle::unlikely_values(plan_.vehicle, mass_);
  of_file.insert(of_file.end(), stops_.begin(), stops_.end());
  for (const auto& [key, what] : of_file)
    odd.emplace_back(context_.key("vehicle"), fmt::format("is {}, whose key '{}' {}", file_.string(), key, what));
  const auto brakes = [](const vehicle::AxleSpec& axle) {
    return axle.corners[vehicle::kLeft].brake || axle.corners[vehicle::kRight].brake;
  };
  if (!plan_.driver && std::none_of(plan_.vehicle.axles.begin(), plan_.vehicle.axles.end(), brakes))
    odd.emplace_back(context_.key("driver"),
                     fmt::format("is missing, and so the brakes hold the vehicle, but {} has no brakes: it may "
                                 "roll",
                                 plan_.vehicle.name));
  if (plan_.driver)
    for (const auto& [key, what] : vehicle::unlikely_values(*plan_.driver, duration_))
      odd.emplace_back(context_.key("driver"), fmt::format("its key '{}': {}", key, what));
  if (plan_.driver && plan_.driver->path)
    for (const std::string& what : oddities_of_path()) odd.emplace_back(context_.key("driver"), what);
  return odd;
}

/// Finds what the vehicle cannot follow of its path. It follows the path as well as it can, but the user may have meant
/// another path.
std::vector<std::string> VehicleRigSpec::oddities_of_path() const {
  std::vector<std::string> odd;
  const vehicle::Path path = vehicle::make_path(*plan_.driver->path, driven_.width);
  const double psi = plan_.options.heading, base = driven_.wheelbase;
  const Vec3 rear = Eigen::AngleAxisd(psi, Vec3::UnitZ()) * vehicle::rear_axle_middle(plan_.vehicle);
  const vehicle::Vec2 axle(plan_.options.start + rear.x(), plan_.options.lateral + rear.y());
  const vehicle::PathPoint nearest = path.at(path.follow({}, axle));
  const double off = (nearest.position - axle).norm();
  if (off > kFarFromPath * base)
    odd.emplace_back(
        fmt::format("has a path that comes no nearer than {:.1f} m to where the rear axle starts, "
                    "x = {:.2f} m, y = {:.2f} m",
                    off, axle.x(), axle.y()));
  else if (nearest.direction.dot(vehicle::Vec2(std::cos(psi), std::sin(psi))) < 0.0)
    odd.emplace_back("has a path that leads backward where the vehicle starts: drivers drive forward and turn round");
  const double tightest = base / std::tan(driven_.steering_lock);
  double sharpest = 0.0;
  for (int piece = 0; piece <= path.end().piece; ++piece)
    for (int i = 0; i < kPlacesOfPiece; ++i)
      sharpest =
          std::max(sharpest,
                   std::abs(path.curvature({piece, static_cast<double>(i) / kPlacesOfPiece}, 0.0, kBendLength * base)));
  if (sharpest * tightest > kTooTight)
    odd.emplace_back(
        fmt::format("has a path that bends with a radius of {:.2f} m, the vehicle {} turns with {:.2f} m at "
                    "least",
                    1.0 / sharpest, plan_.vehicle.name, tightest));
  return odd;
}

/// The wheel that comes nearest to the wall behind the vehicle decides where the vehicle starts.
void VehicleRigSpec::fill_starts(std::span<const WheelSize> tires, double duration, std::optional<double> length,
                                 std::span<const double> margins) {
  FURROW_ASSERT(margins.size() == wheels_.size(), margins.size(), wheels_.size());
  length_ = length;
  duration_ = duration;
  if (start_given || !length) return;
  const bool forward = std::cos(plan_.options.heading) >= 0.0;
  double start = forward ? 0.0 : *length;
  for (std::size_t k = 0; k < wheels_.size(); ++k) {
    const double reach = wheel(k, tires[k], duration).along + margins[k], x = place_of(k).x();
    start = forward ? std::max(start, reach - x) : std::min(start, *length - reach - x);
  }
  plan_.options.start = start;
}

void VehicleRigSpec::complete(json& section) const {
  section["start"] = plan_.options.start;
  section["driver"] = plan_.driver ? vehicle::driver_document(*plan_.driver) : json();
  if (plan_.options.lowering_speed > 0.0) section["lowering_speed"] = plan_.options.lowering_speed;
  section["touchdown_time"] = plan_.options.touchdown_time;
  section["stop_before_wall"] = plan_.options.stop_before_wall;
}

}  // namespace

std::unique_ptr<RigSpec> read_vehicle_rig(const json& section, const ReadContext& context) {
  const std::filesystem::path file = vehicle_file(section, context);
  VehicleRigPlan plan;
  read_fields(section, plan.options);
  if (const double slope = plan.options.slope; slope != 0.0)
    plan.gravity = kStandardGravity * Vec3(-std::sin(slope), 0.0, -std::cos(slope));
  plan.vehicle = vehicle::read_vehicle(file);
  plan.driver = read_driver_of(plan.options.driver, context);
  auto spec = std::make_unique<VehicleRigSpec>(std::move(plan), file, context);
  spec->start_given = says(section, "start");
  spec->drops = section.value("drop_height", 0.0) > 0.0;
  return spec;
}

/// Tire files are next to the vehicle's file, or where a scenario's tire files are.
std::vector<WheelTire> tires_of_vehicle(const json& section, const ReadContext& context) {
  if (says(section, "vehicle") && !section["vehicle"].is_string()) return {};
  const std::filesystem::path file = vehicle_file(section, context);
  const vehicle::VehicleSpec spec = vehicle::read_vehicle(file);
  std::vector<WheelTire> tires;
  for (std::size_t axle = 0; axle < spec.axles.size(); ++axle)
    for (const vehicle::CornerSpec& corner : spec.axles[axle].corners) {
      const std::string& name = corner.wheel.tire;
      const std::filesystem::path found = find_file(name, fmt::format("axles[{}].wheel.tire", axle), file);
      std::error_code error;
      const bool own = std::filesystem::equivalent(found.parent_path(), file.parent_path(), error);
      WheelTire tire{{{"file", own ? std::filesystem::absolute(found, error).string() : name}}, static_cast<int>(axle)};
      if (corner.wheel.rigid) tire.section["rigid"] = true;
      tires.push_back(std::move(tire));
    }
  return tires;
}

}  // namespace furrow::rigs
