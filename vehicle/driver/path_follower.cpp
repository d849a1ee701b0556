#include "vehicle/driver/path_follower.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "protocol/core/assert.hpp"
#include "vehicle/driver/path_shapes.hpp"

namespace furrow::vehicle {
namespace {

constexpr double kWheelbases = 1.5;  // least look-ahead, or distance in which errors decay
constexpr double kWindow = 0.25,
                 kLeastWindow = 0.05;  // wheelbases on each side, for the mean of curvature

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

Vec2 forward(const DriverView& view) { return {std::cos(view.yaw), std::sin(view.yaw)}; }

Vec2 rear_axle(const DriverView& view) { return view.position.head<2>(); }

}  // namespace

PathFollower::PathFollower(const PathSpec& spec, const DriverCar& car)
    : path_(make_path(spec, car.width)), spec_(spec.steering), car_(car) {
  if (auto* law = std::get_if<PurePursuit>(&spec_.law); law && law->lookahead_distance < 0.0)
    law->lookahead_distance = kWheelbases * car.wheelbase;
  if (auto* law = std::get_if<Preview>(&spec_.law); law && law->response_distance < 0.0)
    law->response_distance = kWheelbases * car.wheelbase;
}

void PathFollower::steer(const DriverView& view, PathState& s, DriverRecord& record) const {
  const double step = s.begun ? view.time - s.time : 0.0;
  FURROW_ASSERT(step >= 0.0, view.time, s.time);
  Vec2 axle = rear_axle(view);
  if (std::holds_alternative<Stanley>(spec_.law)) axle += car_.wheelbase * forward(view);
  s.place = path_.follow(s.place, axle);
  const PathPoint nearest = path_.at(s.place);
  record.path_distance = path_.distance(s.place);
  record.cross_track = cross(nearest.direction, axle - nearest.position);
  const double path_yaw = std::atan2(nearest.direction.y(), nearest.direction.x());
  record.heading_error = std::remainder(view.yaw - path_yaw, 2.0 * std::numbers::pi);
  if (path_.is_end(s.place) && !record.path_ended) {
    record.path_ended = true;
    record.path_end_time = view.time;
  }
  const double angle = std::visit([&](const auto& law) { return wheel_angle(law, view, s.place, record); }, spec_.law);
  const double wanted = std::clamp(angle / car_.steering_lock, -1.0, 1.0), reach = spec_.rate * step;
  s.steering = std::clamp(wanted, s.steering - reach, s.steering + reach);
  s.begun = true;
  s.time = view.time;
  record.inputs.steering = s.steering;
}

// Before the start of the path, its first point may be further than D; then the circle goes through this point.
double PathFollower::wheel_angle(const PurePursuit& law, const DriverView& view, const PathPlace& place,
                                 const DriverRecord& record) const {
  const double distance = std::max({law.lookahead_distance, law.lookahead_time * std::abs(view.speed()),
                                    std::numbers::sqrt2 * std::abs(record.cross_track)});
  const Vec2 axle = rear_axle(view);
  const Vec2 ahead = path_.look_ahead(place, axle, distance) - axle;
  const double curvature = 2.0 * cross(forward(view), ahead) / ahead.squaredNorm();
  return std::atan(car_.wheelbase * curvature);
}

double PathFollower::wheel_angle(const Stanley& law, const DriverView& view, const PathPlace&,
                                 const DriverRecord& record) const {
  const double speed = law.soft_speed + std::abs(view.speed());
  return -record.heading_error - std::atan2(law.gain * record.cross_track, speed);
}

double PathFollower::wheel_angle(const Preview& law, const DriverView& view, const PathPlace& place,
                                 const DriverRecord& record) const {
  const double L = car_.wheelbase, v = std::abs(view.speed());
  const auto curvature = [&](double ahead) {
    const double window = std::max(kLeastWindow * L, std::min(kWindow * L, ahead));
    return path_.curvature(place, std::max(0.0, ahead - window), ahead + window);
  };
  const double ahead = curvature(law.preview_time * v), halfway = curvature(0.5 * law.preview_time * v);
  const double d = std::max(law.response_distance, law.response_time * v), most = std::numbers::sqrt2 * d;
  const double error = std::clamp(record.cross_track, -most, most);
  const double heading = record.heading_error - law.side_slip * v * v * halfway;
  const double wanted = ahead - (error + 2.0 * d * std::sin(heading)) / (d * d);
  return std::atan(L * wanted) + law.understeer * v * v * ahead - law.yaw_damping * (view.yaw_rate - v * halfway);
}

}  // namespace furrow::vehicle
