#include "vehicle/analysis/kinematics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "protocol/core/paced_call.hpp"
#include "protocol/files/figures_json.hpp"
#include "protocol/files/json_text.hpp"
#include "vehicle/analysis/held_vehicle.hpp"
#include "vehicle/analysis/wheel_angles.hpp"

namespace furrow::vehicle {
namespace {

constexpr double kRateStep = 5e-4;  // of the travel, for wheel rates, m
constexpr double kSlow = 1e-3;      // of a shock absorber, for its coefficient, m/s
constexpr double kQuiet = 2.0;      // before progress is told, s

/// The left end of a steering.
struct SteeringEnd {
  const char* key;
  double value;
  const char *what, *unit;
};
SteeringEnd end_of(const PitmanArmSpec& s) {
  return {"left_angle_deg", s.left_angle_deg, "angle of the Pitman arm", "degrees"};
}
SteeringEnd end_of(const RackSpec& s) { return {"left_travel", s.left_travel, "travel of the rack", "m"}; }

/// The vehicle with its chassis held, in one posture after another.
class Bench {
 public:
  Bench(const VehicleSpec& spec, std::span<const double> radii)
      : vehicle_(spec), statics_(vehicle_.system()), radii_(radii) {
    FURROW_ASSERT(radii.size() == static_cast<std::size_t>(vehicle_.wheel_count()), radii.size());
    for (HeldRow& row : held_body(vehicle_.system(), vehicle_.chassis())) statics_.hold(std::move(row));
    hold_spins(vehicle_, statics_);
    for (int k = 0; k < vehicle_.wheel_count(); ++k) {
      const Wheel& wheel = vehicle_.wheel(k);
      lifts_.push_back(-1);
      if (wheel.travels)
        lifts_.back() =
            statics_.hold({wheel.name + " travel", offset_row(system(), kGround, wheel.spindle, Vec3::UnitZ())});
    }
  }

  const Vehicle& vehicle() const { return vehicle_; }
  bool lifts(int axle) const { return lifts_[2 * axle] >= 0; }
  bool steers(int axle) { return vehicle_.steering(axle).has_value(); }

  /// Lifts the wheels of one axle; the others stay as drawn.
  void take(int axle, double left, double right, double steering) {
    for (int k = 0; k < vehicle_.wheel_count(); ++k)
      if (lifts_[k] >= 0) statics_.set_target(lifts_[k], k / 2 != axle ? 0.0 : k % 2 == kLeft ? left : right);
    if (steers(axle)) vehicle_.steering(axle)->put(steering);
    if (const Outcome outcome = statics_.close(); !outcome.ok)
      throw physics_error(
          outcome, "axle '" + vehicle_.spec().axles[axle].name + "'",
          fmt::format(" with its wheels lifted by {:.3g} and {:.3g} m", left, right) + steering_text(axle, steering));
  }

  /// Position of the axle's rack or arm at a steering input, as text; empty straight ahead.
  std::string steering_text(int axle, double steering) const {
    const auto& spec = vehicle_.spec().axles[axle].steering;
    if (steering == 0.0 || !spec) return "";
    const SteeringEnd at = std::visit([](const auto& s) { return end_of(s); }, *spec);
    return fmt::format(", steering {:.3g}: a {} of {:.3g} {}", steering, at.what, steering * at.value, at.unit);
  }

  /// Displacements for the rate 1 of the left wheel and the rate `right` of the right wheel.
  Eigen::VectorXd tangent(int axle, double right) const {
    return statics_.tangent(lifts_[2 * axle]) + right * statics_.tangent(lifts_[2 * axle + 1]);
  }

  /// Takes a posture; of the axle's wheels the wheel rates there.
  std::array<double, 2> wheel_rates(int axle, double left, double right, double steering);
  double damping_ratio(int k, double wheel_rate, const Eigen::VectorXd& parallel) const;
  KinematicsRow row(int k) const;
  void add_slopes(int axle, double middle, KinematicsRow* rows) const;
  double support(int k, const Eigen::VectorXd& parallel) const;
  double ratio(const std::optional<int>& element, const Eigen::VectorXd& tangent) const;

 private:
  const System& system() const { return vehicle_.system(); }
  Vec3 contact_point(int k) const {
    return system().body(vehicle_.wheel(k).spindle).state.position + radii_[k] * down_in_wheel(spin_axis(vehicle_, k));
  }
  /// Velocity of the contact point as a point of the wheel's carrier.
  Vec3 contact_rate(int k, const Eigen::VectorXd& tangent) const {
    const int body = vehicle_.wheel(k).carrier;
    const Vec3 w = tangent.segment<3>(6 * body + 3);
    return tangent.segment<3>(6 * body) + w.cross(contact_point(k) - system().body(body).state.position);
  }

  Vehicle vehicle_;
  Statics statics_;
  std::span<const double> radii_;
  std::vector<int> lifts_;  // held row of each wheel's travel, or −1
};

double Bench::ratio(const std::optional<int>& element, const Eigen::VectorXd& tangent) const {
  if (!element) return KinematicsRow::kNone;
  const Row& row = system().element(*element).row;
  const RowJacobian J = row_jacobian(row, system().pose(row.a), system().pose(row.b));
  double rate = 0.0;
  each_side(row, J, [&](int body, const Vec3& v, const Vec3& w) {
    rate += v.dot(tangent.segment<3>(6 * body)) + w.dot(tangent.segment<3>(6 * body + 3));
  });
  return -rate;
}

double Bench::support(int k, const Eigen::VectorXd& parallel) const {
  const std::optional<int>& spring = vehicle_.wheel(k).spring;
  if (!spring) return KinematicsRow::kNone;
  const ForceElement& e = system().element(*spring);
  return e.law(row_value(system(), e.row), 0.0, 0.0).force * ratio(spring, parallel);
}

std::array<double, 2> Bench::wheel_rates(int axle, double left, double right, double steering) {
  std::array<double, 2> rates{};
  for (const double step : {-kRateStep, kRateStep, 0.0}) {
    take(axle, left + step, right + step, steering);
    if (step == 0.0) break;
    const Eigen::VectorXd parallel = tangent(axle, 1.0);
    for (int side = 0; side < 2; ++side)
      rates[side] += (step > 0.0 ? 0.5 : -0.5) / kRateStep * support(2 * axle + side, parallel);
  }
  return rates;
}

double Bench::damping_ratio(int k, double wheel_rate, const Eigen::VectorXd& parallel) const {
  const std::optional<int>& shock = vehicle_.wheel(k).shock;
  const double carried = support(k, parallel);
  if (!shock || !(wheel_rate > 0.0) || !(carried > 0.0)) return KinematicsRow::kNone;
  const ForceElement& e = system().element(*shock);
  const double length = row_value(system(), e.row), moved = ratio(shock, parallel);
  const double damping =
      (e.law(length, -kSlow, 0.0).force - e.law(length, kSlow, 0.0).force) / (2.0 * kSlow) * moved * moved;
  return damping / (2.0 * std::sqrt(wheel_rate * carried / system().gravity().norm()));
}

KinematicsRow Bench::row(int k) const {
  const Wheel& wheel = vehicle_.wheel(k);
  const double side = outward(wheel.side);
  const Vec3 a = spin_axis(vehicle_, k), touching = contact_point(k);
  const Vec3 center = system().body(wheel.spindle).state.position;
  KinematicsRow r;
  r.wheel = wheel.name;
  r.travel = center.z() - spindle_of(wheel.corner->suspension).center.z();
  r.camber = camber_angle(a, side);
  r.toe = toe_angle(a, side);
  r.steer = steer_angle(a);
  r.half_track = std::abs(touching.y());
  r.wheel_x = center.x();
  const auto length = [&](const std::optional<int>& e) {
    return e ? row_value(system(), system().element(*e).row) : KinematicsRow::kNone;
  };
  r.spring_length = length(wheel.spring);
  r.shock_length = length(wheel.shock);
  if (wheel.kingpin) {
    const Body& carrier = system().body(wheel.carrier);
    const Vec3 low = carrier.state.position + carrier.R * wheel.kingpin->lower;
    const Vec3 u = (carrier.R * (wheel.kingpin->upper - wheel.kingpin->lower)).normalized();
    const Vec3 at_ground = low + (touching.z() - low.z()) / u.z() * u;
    r.caster = caster_angle(u);
    r.kingpin = kingpin_angle(u, side);
    r.scrub = side * (touching.y() - at_ground.y());
    r.trail = at_ground.x() - touching.x();
  }
  return r;
}

/// Quantities from the motion's derivatives, for the two wheels of an axle. @param middle x between first and last axle
void Bench::add_slopes(int axle, double middle, KinematicsRow* rows) const {
  const Eigen::VectorXd parallel = tangent(axle, 1.0), opposite = tangent(axle, -1.0);
  for (int side = 0; side < 2; ++side) {
    const int k = 2 * axle + side;
    const Wheel& wheel = vehicle_.wheel(k);
    KinematicsRow& r = rows[side];
    // In the opposite motion, the right wheel has the rate −1.
    r.roll_center = contact_point(k).y() * contact_rate(k, opposite).y() * outward(side);
    r.brake_slope = contact_rate(k, parallel).x() * (contact_point(k).x() > middle ? 1.0 : -1.0);
    r.spring_ratio = ratio(wheel.spring, parallel);
    r.shock_ratio = ratio(wheel.shock, parallel);
  }
}

/// Distances of the whole vehicle that anti-dive and Ackermann refer to, as drawn.
struct Base {
  double wheelbase = 0.0;            // between first and last axle, m
  double middle = 0.0;               // x between them, m
  double height = 0.0;               // of the centre of mass above the ground, m
  std::vector<double> brake_shares;  // of each wheel, of all braking
};

Base base_of(const Vehicle& vehicle, std::span<const double> radii) {
  Base base;
  Vec3 moment = Vec3::Zero();
  double mass = 0.0, front = -1e300, rear = 1e300, ground = 0.0, brakes = 0.0;
  for (int i = 0; i < vehicle.system().body_count(); ++i) {
    const Body& body = vehicle.system().body(i);
    moment += body.mass * body.state.position;
    mass += body.mass;
  }
  for (int k = 0; k < vehicle.wheel_count(); ++k) {
    const Vec3 center = vehicle.rim(k).position;
    front = std::max(front, center.x());
    rear = std::min(rear, center.x());
    ground += (center.z() - radii[k]) / vehicle.wheel_count();
    base.brake_shares.push_back(vehicle.wheel(k).corner->brake ? vehicle.wheel(k).corner->brake->torque / radii[k]
                                                               : 0.0);
    brakes += base.brake_shares.back();
  }
  for (double& share : base.brake_shares) share = brakes > 0.0 ? share / brakes : KinematicsRow::kNone;
  base.wheelbase = front - rear;
  base.middle = 0.5 * (front + rear);
  base.height = moment.z() / mass - ground;
  return base;
}

/// x of the axle about which the vehicle turns: the mean of the unsteered axles.
double turning_line(Bench& bench) {
  double sum = 0.0;
  int count = 0;
  for (std::size_t k = 0; k < bench.vehicle().spec().axles.size(); ++k)
    if (!bench.steers(static_cast<int>(k))) {
      sum += spindle_of(bench.vehicle().spec().axles[k].corners[kLeft].suspension).center.x();
      ++count;
    }
  return count > 0 ? sum / count : KinematicsRow::kNone;
}

void add_ackermann(KinematicsRow* rows, double line) {
  const double left = rows[kLeft].steer, right = rows[kRight].steer;
  if (std::abs(left) < 1e-3 || std::abs(right) < 1e-3 || left * right < 0.0) return;
  const double track = rows[kLeft].half_track + rows[kRight].half_track;
  const double ahead = 0.5 * (rows[kLeft].wheel_x + rows[kRight].wheel_x) - line, wheelbase = std::abs(ahead);
  const bool left_inside = (left > 0.0) == (ahead > 0.0);  // wheels behind the line turn out of the curve
  const double inner = std::abs(left_inside ? left : right), outer = std::abs(left_inside ? right : left);
  const double ideal = std::atan(1.0 / (1.0 / std::tan(inner) + track / wheelbase));
  rows[kLeft].ackermann = rows[kRight].ackermann = (inner - outer) / (inner - ideal);
}

/// Number of steps that an axle can make, of equal ones from straight ahead to one end of the steering.
int steps_reached(const VehicleSpec& spec, std::span<const double> radii, int axle, double end, int steps) {
  Bench bench(spec, radii);
  int reached = 0;
  try {
    for (; reached < steps; ++reached) bench.take(axle, 0.0, 0.0, end * (reached + 1) / steps);
  } catch (const Error& error) {
    if (error.code() != ExitCode::physics) throw;
  }
  return reached;
}

class Sweep {
 public:
  Sweep(const VehicleSpec& spec, std::span<const double> radii, const KinematicsOptions& options,
        const ProgressCall& progress)
      : bench_(spec, radii),
        options_(options),
        base_(base_of(bench_.vehicle(), radii)),
        line_(turning_line(bench_)),
        tell_(progress, kQuiet) {
    for (int axle = 0; axle < axle_count(); ++axle)
      if (bench_.lifts(axle)) postures_ += options_.points * (bench_.steers(axle) ? 3 : 2);
  }

  std::vector<KinematicsRow> run() {
    for (int axle = 0; axle < axle_count(); ++axle) {
      if (!bench_.lifts(axle)) continue;
      add(axle, "parallel", options_.travel, options_.travel, 0.0);
      add(axle, "opposite", options_.travel, -options_.travel, 0.0);
      if (bench_.steers(axle)) add(axle, "steering", 0.0, 0.0, 1.0);
    }
    return std::move(rows_);
  }

 private:
  int axle_count() const { return static_cast<int>(bench_.vehicle().spec().axles.size()); }

  void add(int axle, const char* motion, double left, double right, double steering) {
    std::vector<KinematicsRow> both[2];
    const int last = options_.points - 1;
    for (int i = 0; i < options_.points; ++i) {
      tell_("moving the suspensions", static_cast<double>(done_++) / postures_);
      const double share = last > 0 ? 2.0 * i / last - 1.0 : 0.0;
      KinematicsRow rows[2];
      const std::array<double, 2> rates = bench_.wheel_rates(axle, share * left, share * right, share * steering);
      for (int side = 0; side < 2; ++side) {
        rows[side] = bench_.row(2 * axle + side);
        rows[side].motion = motion;
        rows[side].steering = steering == 0.0 ? 0.0 : share * steering;  // not -0
        rows[side].wheel_rate = rates[side];
      }
      bench_.add_slopes(axle, base_.middle, rows);
      for (int side = 0; side < 2; ++side)
        rows[side].anti_dive =
            rows[side].brake_slope * 2.0 * base_.brake_shares[2 * axle + side] * base_.wheelbase / base_.height;
      if (steering != 0.0) add_ackermann(rows, line_);
      for (int side = 0; side < 2; ++side) both[side].push_back(rows[side]);
    }
    for (const auto& rows : both) rows_.insert(rows_.end(), rows.begin(), rows.end());
  }

  Bench bench_;
  KinematicsOptions options_;
  Base base_;
  double line_;
  PacedCall tell_;
  int postures_ = 0, done_ = 0;
  std::vector<KinematicsRow> rows_;
};

}  // namespace

std::vector<KinematicsRow> kinematics(const VehicleSpec& spec, std::span<const double> radii,
                                      const KinematicsOptions& options, const ProgressCall& progress) {
  FURROW_ASSERT(options.points > 0, options.points);
  return Sweep(spec, radii, options, progress).run();
}

std::vector<double> damping_ratios(const VehicleSpec& spec, std::span<const double> radii,
                                   std::span<const double> travel) {
  FURROW_ASSERT(travel.size() == radii.size(), travel.size(), radii.size());
  Bench bench(spec, radii);
  std::vector<double> ratios(travel.size(), KinematicsRow::kNone);
  for (std::size_t k = 0; k + 1 < travel.size(); k += 2) {
    const int axle = static_cast<int>(k / 2);
    if (!bench.lifts(axle)) continue;
    const std::array<double, 2> rates = bench.wheel_rates(axle, travel[k], travel[k + 1], 0.0);
    const Eigen::VectorXd parallel = bench.tangent(axle, 1.0);
    for (int side = 0; side < 2; ++side)
      ratios[k + side] = bench.damping_ratio(static_cast<int>(k) + side, rates[side], parallel);
  }
  return ratios;
}

void check_locks(const VehicleSpec& spec, std::span<const double> radii, const ProgressCall& progress) {
  constexpr int kSteps = 8, kFineSteps = 50;
  const auto steered =
      std::count_if(spec.axles.begin(), spec.axles.end(), [](const AxleSpec& one) { return one.steering.has_value(); });
  PacedCall tell(progress);
  double ends = 0.0;
  for (std::size_t k = 0; k < spec.axles.size(); ++k) {
    if (!spec.axles[k].steering) continue;
    const int axle = static_cast<int>(k);
    for (const double end : {-1.0, 1.0}) {
      tell("moving the steerings", ends++ / (2.0 * static_cast<double>(steered)));
      if (steps_reached(spec, radii, axle, end, kSteps) == kSteps) continue;
      const int reached = steps_reached(spec, radii, axle, end, kFineSteps);
      if (reached == kFineSteps) continue;
      const SteeringEnd at = std::visit([](const auto& s) { return end_of(s); }, *spec.axles[k].steering);
      const double share = end * reached / kFineSteps;
      throw input_error(
          spec.file, fmt::format("axles[{}].steering.{}", k, at.key),
          fmt::format("is {0} {1}, the {2} that full steering asks for, expected at most {3:.3g} {1} in "
                      "magnitude: steering {4:g} asks for {5:.3g} {1}, but the linkage of axle '{6}' ends at "
                      "{7:.3g} {1}, steering {8:.2g}",
                      number_text(at.value), at.unit, at.what, std::abs(at.value * share), end, end * at.value,
                      spec.axles[k].name, share * at.value, share));
    }
  }
}

const char* end_key(const SteeringSpec& steering) {
  return std::visit([](const auto& s) { return end_of(s).key; }, steering);
}

std::vector<double> full_steering(const VehicleSpec& spec, std::span<const double> radii) {
  constexpr int kSteps = 50;
  std::vector<double> angles;
  for (int axle = 0; axle < static_cast<int>(spec.axles.size()); ++axle) {
    angles.push_back(0.0);
    if (!spec.axles[axle].steering) continue;
    Bench bench(spec, radii);
    for (int i = 1; i <= kSteps; ++i) bench.take(axle, 0.0, 0.0, static_cast<double>(i) / kSteps);
    angles.back() = 0.5 * (bench.row(2 * axle).steer + bench.row(2 * axle + 1).steer);
  }
  return angles;
}

std::string kinematics_csv(std::span<const KinematicsRow> rows) {
  std::string text, separator;
  const KinematicsRow head;
  visit_fields(head, [&](const auto&, const Field& field) {
    text += separator + name_with_unit(field);
    separator = ",";
  });
  text += '\n';
  for (const KinematicsRow& row : rows) {
    separator.clear();
    visit_fields(row, [&](const auto& value, const Field&) {
      text += separator;
      separator = ",";
      if constexpr (std::is_same_v<std::decay_t<decltype(value)>, std::string>)
        text += value;
      else if (std::isfinite(value))
        text += fmt::format("{}", value);
    });
    text += '\n';
  }
  return text;
}

}  // namespace furrow::vehicle
