// Holds a speed that is a function of time, by a PI law with one demand u for both pedals. With the error
// e = target − speed and the largest drive and brake forces F and B:
//
//   u = k_p e + I,  İ = k_i e,  −B/F ≤ u ≤ 1
//   throttle = u,  brake = −u F/B
//
// so that u F is the wanted force for either pedal. A mass m without resistance then obeys ë + (F k_p/m) ė + (F k_i/m)
// e = 0. By default k_p = 2 ζ ω m/F and k_i = ω² m/F with ω = 0.5 rad/s and ζ = 1, critical damping.
//
// Anti-windup by conditional integration [Åström & Hägglund 2006, §3.5]: I is constant while u is at a bound and I
// would move it further out. The foot changes to the brake when u falls below −h, and back to the throttle when u rises
// above h. Between −h and h, a pedal whose demand is negative is released. At target 0 and below the stop speed the
// brake is pressed fully and I is cleared, until the target rises.
//
// K. J. Åström, T. Hägglund, Advanced PID Control, ISA 2006, ISBN 978-1-55617-942-6.
#pragma once

#include <string>

#include "protocol/core/fields.hpp"
#include "vehicle/driver/driver.hpp"
#include "vehicle/driver/driver_spec.hpp"
#include "vehicle/multibody/table.hpp"

namespace furrow::vehicle {

struct SpeedState {
  bool begun = false;     // it was asked before
  double time = 0.0;      // of the last call, s
  double error = 0.0;     // then, m/s
  double integral = 0.0;  // I, of throttle
  bool braking = false;   // whether the foot is on the brake
  bool stopped = false;   // whether the vehicle has stopped and the brake holds it
};
void visit_fields(FieldsOf<SpeedState> auto& s, auto&& visit) {
  visit(s.begun, Field{"begun", ""});
  visit(s.time, Field{"time", "s"});
  visit(s.error, Field{"error", "m/s"});
  visit(s.integral, Field{"integral"});
  visit(s.braking, Field{"braking", ""});
  visit(s.stopped, Field{"stopped", ""});
}

class SpeedControl {
 public:
  SpeedControl(const SpeedSpec& spec, const DriverCar& car);

  double target(double time) const { return target_.value(time); }
  double proportional() const { return proportional_; }  // k_p, s/m
  double integral() const { return integral_; }          // k_i, 1/m
  /// Sets throttle and brake. @pre time ≥ state.time
  void press(double time, double speed, SpeedState& state, DriverInputs& inputs) const;

 private:
  void split(double demand, SpeedState& state, DriverInputs& inputs) const;

  Table target_;
  double proportional_, integral_;  // k_p, k_i
  double hysteresis_, stop_speed_;  // h, m/s
  double brake_ratio_;              // B/F
};

/// The function of time through these points, constant beyond them; 0 without points.
Table table_of_time(const std::string& name, DriverPoints points);

}  // namespace furrow::vehicle
