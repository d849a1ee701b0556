// An electric motor as a torque on its shaft, with the reaction on the shaft's carrier: T = T_stall (c − u/u₀), with a
// command c between −1 and 1 and u₀ the speed without load. c = 0 brakes.
#pragma once

#include <memory>
#include <string>

#include "vehicle/multibody/system.hpp"

namespace furrow::vehicle {

struct WheelMotorOptions {
  double stall_torque = 0.0;   // N m
  double no_load_speed = 0.0;  // rad/s
};

class WheelMotor {
 public:
  /// @throws Error(physics) for options that are not positive
  WheelMotor(System& system, const std::string& name, int shaft, const WheelMotorOptions& options);

  void set_command(double command);  // −1 to 1
  /// Since the start, J.
  double work(const System& system) const { return system.rate_state(row_).work; }

  void save(Archive& archive) const { archive.put("command", *command_); }
  void restore(const Archive& archive) { *command_ = archive.get_double("command"); }

 private:
  std::shared_ptr<double> command_ = std::make_shared<double>(0.0);  // shared with the law
  int row_ = 0;
};

}  // namespace furrow::vehicle
