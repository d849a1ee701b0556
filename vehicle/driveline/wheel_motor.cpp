#include "vehicle/driveline/wheel_motor.hpp"

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"

namespace furrow::vehicle {

WheelMotor::WheelMotor(System& system, const std::string& name, int shaft, const WheelMotorOptions& options) {
  if (!(options.stall_torque > 0.0) || !(options.no_load_speed > 0.0))
    throw physics_error("motor '" + name + "': its stall torque and its speed without load must be positive");
  const double slope = options.stall_torque / options.no_load_speed;
  row_ = system.add_rate_law(RateRow{name, {{shaft, 1.0}}, {}},
                             [stall = options.stall_torque, slope, command = command_](
                                 std::span<const double> speeds, double, std::span<ElementForce> torques) {
                               torques[0] = {stall * *command - slope * speeds[0], slope};
                             });
}

void WheelMotor::set_command(double command) {
  FURROW_ASSERT(command >= -1.0 && command <= 1.0, command);
  *command_ = command;
}

}  // namespace furrow::vehicle
