// The driveline of a vehicle, built from its spec: shafts, the parts that join them, and the drives. Reactions act on
// the shafts' carriers: of engine, gearbox and gears on the chassis or an axle's housing, of wheel motors on the body
// that holds the wheel's bearing.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "vehicle/driveline/engine.hpp"
#include "vehicle/driveline/friction_coupling.hpp"
#include "vehicle/driveline/gearbox.hpp"
#include "vehicle/driveline/shift_logic.hpp"
#include "vehicle/driveline/torque_converter.hpp"
#include "vehicle/driveline/wheel_motor.hpp"
#include "vehicle/parts/suspension.hpp"

namespace furrow::vehicle {

enum class Selector { drive, neutral, reverse };

/// A driver's commands.
struct VehicleInputs {
  double throttle = 0.0;  // 0 to 1; of wheel motors −1 to 1
  double brake = 0.0;     // 0 to 1
  double steering = 0.0;  // −1 to 1, left positive
  Selector selector = Selector::drive;
  bool lock = false;  // of all differentials that can be locked
  int gear = 0;       // forward gear to hold, from 1; 0: the gearbox decides
};

class DriveTrain {
 public:
  /// @param wheels of the vehicle, two for each axle
  DriveTrain(System& system, const VehicleSpec& vehicle, int chassis, std::span<const Wheel> wheels);

  void set_inputs(System& system, const VehicleInputs& inputs);
  /// Turns shafts and rotors to match wheels with these spins, rad/s, in a forward gear from 1, or with 0 in the lowest
  /// gear that the gearbox would keep. The engine turns at least at idle speed. @pre before the first step; assemble()
  /// must follow
  void begin_rolling(System& system, std::span<const double> spins, int gear);
  /// To be called before every step of size h: operates shifts and clutch.
  Outcome advance(System& system, double h);

  /// Index of a shaft in the system. @pre there is one of this name
  int shaft(const std::string& name) const;
  const std::optional<Engine>& engine() const { return engine_; }
  const std::optional<TorqueConverter>& converter() const { return converter_; }
  const std::optional<FrictionCoupling>& clutch() const { return clutch_; }
  const std::optional<Gearbox>& gearbox() const { return gearbox_; }
  const std::vector<FrictionCoupling>& locks() const { return locks_; }
  /// Work of engine and motors since the start, J, and energy dissipated by converter, clutches and gearbox.
  double work(const System& system) const;
  double loss(const System& system) const;

  void save(Archive& archive) const;
  void restore(const Archive& archive);

 private:
  void add_shafts(System& system, int chassis, std::span<const Wheel> wheels);
  void add_drives(System& system);
  void add_gears(System& system);
  void add_wheels(System& system, std::span<const Wheel> wheels);
  void add_motors(System& system, std::span<const Wheel> wheels);
  int wanted_gear(const System& system);

  const VehicleSpec& vehicle_;
  const DrivelineSpec& spec_;
  std::vector<int> shafts_;  // in the order of the spec
  std::optional<Engine> engine_;
  std::optional<TorqueConverter> converter_;
  std::optional<FrictionCoupling> clutch_;
  std::optional<Gearbox> gearbox_;
  ShiftLogic logic_;
  std::vector<FrictionCoupling> locks_;
  std::vector<WheelMotor> motors_;
  std::vector<int> rotors_;  // shafts of the motors
  Selector selector_ = Selector::drive;
  int held_gear_ = 0;  // VehicleInputs::gear
};

}  // namespace furrow::vehicle
