#include "rigs/vehicle/vehicle_findings.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "vehicle/driver/lane_change.hpp"

namespace furrow::rigs {
namespace {

constexpr double kLifted = 0.01, kDown = 0.05, kTouched = 0.5;  // of the load at rest
constexpr double kLeastLift = 0.01;                             // s
constexpr std::size_t kMostLifts = 1000;                        // largest number reported
constexpr int kErrorFields = 7, kWheelFields = 3, kLiftFields = 3;

}  // namespace

VehicleFindings::VehicleFindings(std::vector<double> loads, const std::optional<vehicle::DriverSpec>& driver,
                                 const vehicle::DriverCar& car)
    : loads_(std::move(loads)), wheelbase_(car.wheelbase), width_(car.width), wheels_(loads_.size()) {
  if (driver) path_ = driver->path;
}

void VehicleFindings::wheel(int k, double force, double time) {
  FURROW_ASSERT(in_range(k, wheels_.size()), k, wheels_.size());
  Wheel& wheel = wheels_[k];
  const double load = loads_[k];
  wheel.touched = wheel.touched || force >= kTouched * load;
  if (!wheel.touched) return;
  if (!wheel.lifted && force < kLifted * load) wheel.lifted = true, wheel.since = time;
  if (!wheel.lifted || force < kDown * load) return;
  wheel.lifted = false;
  if (time - wheel.since >= kLeastLift && lifts_.size() < kMostLifts)
    lifts_.push_back({"wheel_lift", k, wheel.since, time});
}

void VehicleFindings::path(const vehicle::DriverView& view, const vehicle::DriverRecord& record) {
  if (!path_ || record.path_ended) return;
  PathErrors& e = errors_;
  e.count += 1.0;
  e.squares += record.cross_track * record.cross_track;
  if (std::abs(record.cross_track) > std::abs(e.largest)) e.largest = record.cross_track, e.largest_at = view.time;
  const auto* change = std::get_if<vehicle::LaneChangePath>(&path_->shape);
  if (!change) return;
  const double turn = path_->heading_deg * std::numbers::pi / 180.0, yaw = view.yaw - turn;
  const double dx = view.position.x() - path_->x, dy = view.position.y() - path_->y;
  const double x = std::cos(turn) * dx + std::sin(turn) * dy - change->lead_in,
               y = -std::sin(turn) * dx + std::cos(turn) * dy;
  for (const vehicle::Lane& lane : vehicle::lanes_of(change->track, width_))
    for (const double along : {0.0, wheelbase_})
      for (const double across : {-0.5 * width_, 0.5 * width_}) {
        const double cx = x + along * std::cos(yaw) - across * std::sin(yaw),
                     cy = y + along * std::sin(yaw) + across * std::cos(yaw);
        if (cx < lane.start || cx > lane.end) continue;
        const double margin = 0.5 * lane.width - std::abs(cy - lane.centre);
        if (e.lanes == 0.0 || margin < e.margin) e.lanes = 1.0, e.margin = margin, e.margin_at = view.time;
      }
}

void VehicleFindings::gear(int gear) {
  if (geared_ && gear != gear_) ++changes_;
  geared_ = true;
  gear_ = gear;
}

RigFindings VehicleFindings::told() const {
  RigFindings told;
  told.events = lifts_;
  for (std::size_t k = 0; k < wheels_.size(); ++k)
    if (wheels_[k].lifted && told.events.size() < kMostLifts)
      told.events.push_back({"wheel_lift", static_cast<int>(k), wheels_[k].since});
  std::stable_sort(told.events.begin(), told.events.end(),
                   [](const RigEvent& a, const RigEvent& b) { return a.from < b.from; });
  told.figures.emplace_back("gear_changes", changes_);
  if (errors_.count == 0.0) return told;
  told.figures.emplace_back("path_error_rms_m", std::sqrt(errors_.squares / errors_.count));
  told.figures.emplace_back("path_error_largest_m", errors_.largest);
  told.figures.emplace_back("path_error_largest_at_s", errors_.largest_at);
  if (errors_.lanes == 0.0) return told;
  told.figures.emplace_back("lane_margin_least_m", errors_.margin);
  told.figures.emplace_back("lane_margin_least_at_s", errors_.margin_at);
  return told;
}

void VehicleFindings::save(Archive& archive) const {
  const Archive::Scope scope(archive, "findings/");
  std::vector<double> wheels, lifts;
  for (const Wheel& w : wheels_)
    for (const double value : {double(w.touched), double(w.lifted), w.since}) wheels.push_back(value);
  for (const RigEvent& lift : lifts_)
    for (const double value : {double(lift.wheel), lift.from, lift.to}) lifts.push_back(value);
  const PathErrors& e = errors_;
  archive.put("wheels", wheels);
  archive.put("lifts", lifts);
  archive.put("path", std::vector<double>{e.count, e.squares, e.largest, e.largest_at, e.margin, e.margin_at, e.lanes});
  archive.put("gear", std::vector<std::int64_t>{geared_, gear_, changes_});
}

void VehicleFindings::restore(const Archive& archive) {
  const Archive::Scope scope(archive, "findings/");
  const std::vector<double>& wheels = archive.get<double>("wheels", kWheelFields * wheels_.size());
  for (std::size_t k = 0; k < wheels_.size(); ++k)
    wheels_[k] = {wheels[kWheelFields * k] != 0.0, wheels[kWheelFields * k + 1] != 0.0, wheels[kWheelFields * k + 2]};
  const std::vector<double>& lifts = archive.get<double>("lifts");
  if (lifts.size() % kLiftFields != 0)
    throw Error(ExitCode::io, "saved findings of the vehicle are cut off: their lifted wheels are not threes");
  lifts_.clear();
  for (std::size_t i = 0; i < lifts.size(); i += kLiftFields)
    lifts_.push_back({"wheel_lift", static_cast<int>(lifts[i]), lifts[i + 1], lifts[i + 2]});
  const std::vector<double>& e = archive.get<double>("path", kErrorFields);
  errors_ = {e[0], e[1], e[2], e[3], e[4], e[5], e[6]};
  const std::vector<std::int64_t>& gear = archive.get<std::int64_t>("gear", 3);
  geared_ = gear[0] != 0, gear_ = static_cast<int>(gear[1]), changes_ = static_cast<int>(gear[2]);
}

}  // namespace furrow::rigs
