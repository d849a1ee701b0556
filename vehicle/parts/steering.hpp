// The steering of an axle: the body that holds the tie rods' inner ends, and its motion with the steering wheel. The
// input s runs from −1 (fully to the right) to 1 (fully to the left) and follows its target s* as
//   T² s″ + 2 T s′ + s = s*,
// which is solved exactly, so that s and s′ are continuous for any step.
#pragma once

#include <memory>
#include <string>

#include "protocol/core/fields.hpp"
#include "vehicle/multibody/system.hpp"
#include "vehicle/spec/vehicle_spec.hpp"

namespace furrow::vehicle {

struct SteeringState {
  double since = 0.0;                            // s; below, at that time
  double value = 0.0, rate = 0.0, target = 0.0;  // s, s′ (1/s), s*
};
void visit_fields(FieldsOf<SteeringState> auto& s, auto&& visit) {
  visit(s.since, Field{"since", "s"});
  visit(s.value, Field{"value"});
  visit(s.rate, Field{"rate", "1/s"});
  visit(s.target, Field{"target"});
}

class Steering {
 public:
  /// Bodies, joints and the motor that moves them.
  Steering(System& system, const std::string& axle, const SteeringSpec& spec, int chassis);

  int rods() const { return rods_; }    // body that the tie rods' inner ends are on
  int motor() const { return motor_; }  // of arm or rack
  /// The coordinate that the motor moves, rad or m, at a time, s.
  double coordinate(double time) const { return full_left_ * input(time).value; }
  /// The input and its rate at a time, s.
  Motion input(double time) const;
  /// Sets the target from `time` on. @pre −1 ≤ target ≤ 1
  void set_target(double time, double target);
  /// Sets the input at rest at a value, for postures.
  void put(double value);

  void save(Archive& archive) const;
  void restore(const Archive& archive);

 private:
  struct Follower {
    double response_time = 0.0;  // T, s
    SteeringState state;
    Motion at(double time) const;
  };
  void add_pitman_arm(System& system, const std::string& axle, const PitmanArmSpec& spec, int chassis);
  void add_rack(System& system, const std::string& axle, const RackSpec& spec, int chassis);
  void add_motor(System& system, const std::string& axle, int joint, double full_left, double response_time);

  std::shared_ptr<Follower> follower_ = std::make_shared<Follower>();  // shared with the motor
  int rods_ = 0, motor_ = 0;
  double full_left_ = 0.0;  // of the motor's coordinate, rad or m
};

}  // namespace furrow::vehicle
