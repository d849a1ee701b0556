#include "vehicle/driver/file_driver.hpp"

#include <algorithm>
#include <cmath>

#include "protocol/core/archive_fields.hpp"
#include "protocol/core/assert.hpp"
#include "vehicle/driver/path_follower.hpp"
#include "vehicle/driver/speed_control.hpp"

namespace furrow::vehicle {
namespace {

struct FileDriverState {
  SpeedState speed;
  PathState path;
  DriverRecord record;
};
void visit_fields(FieldsOf<FileDriverState> auto& s, auto&& visit) {
  visit(s.speed, Field{"speed", ""});
  visit(s.path, Field{"path", ""});
  visit(s.record, Field{"record", ""});
}

/// The value of the last point reached, or of the first point before it; `without` if there are no points.
int step_at(const DriverPoints& points, double time, int without) {
  if (points.empty()) return without;
  const auto next =
      std::upper_bound(points.begin(), points.end(), time, [](double t, const auto& point) { return t < point.first; });
  return static_cast<int>(next == points.begin() ? next->second : std::prev(next)->second);
}

class FileDriver final : public Driver {
 public:
  FileDriver(const DriverSpec& spec, const DriverCar& car)
      : throttle_(table_of_time("throttle", spec.inputs.throttle)),
        brake_(table_of_time("brake", spec.inputs.brake)),
        steering_(table_of_time("steering", spec.inputs.steering)),
        gear_(spec.inputs.gear),
        lock_(spec.inputs.lock) {
    if (spec.speed) speed_.emplace(*spec.speed, car);
    if (spec.path) path_.emplace(*spec.path, car);
  }

  DriverInputs drive(const DriverView& view) override {
    FURROW_ASSERT(view.position.allFinite() && view.velocity.allFinite() && std::isfinite(view.yaw), view.time);
    DriverRecord& record = state_.record;
    DriverInputs& inputs = record.inputs;
    inputs.gear = step_at(gear_, view.time, gear_request::automatic);
    inputs.lock = step_at(lock_, view.time, 0) == 1;
    if (speed_) {
      record.target_speed = speed_->target(view.time);
      speed_->press(view.time, view.speed(), state_.speed, inputs);
    } else {
      inputs.throttle = throttle_.value(view.time);
      inputs.brake = brake_.value(view.time);
    }
    if (path_)
      path_->steer(view, state_.path, record);
    else
      inputs.steering = steering_.value(view.time);
    return inputs;
  }
  const DriverRecord& record() const override { return state_.record; }
  void save(Archive& archive) const override { save_fields(archive, "driver", state_); }
  void restore(const Archive& archive) override { restore_fields(archive, "driver", state_); }

 private:
  Table throttle_, brake_, steering_;
  DriverPoints gear_, lock_;
  std::optional<SpeedControl> speed_;
  std::optional<PathFollower> path_;
  FileDriverState state_;
};

}  // namespace

std::unique_ptr<Driver> make_driver(const DriverSpec& spec, const DriverCar& car) {
  visit_fields(car, [](const double& value, const Field& field) { FURROW_ASSERT(value > 0.0, field.name, value); });
  return std::make_unique<FileDriver>(spec, car);
}

}  // namespace furrow::vehicle
