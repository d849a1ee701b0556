// An engine as a torque on its crank shaft, with the reaction on the shaft's carrier:
//   T = s · full(u) + losses(u),   s = max(throttle, governor),   governor = clamp((idle − u)/band, 0, 1)
// u is the speed of the crank shaft relative to its carrier, rad/s. The governor prevents stalling; idle = 0 means no
// governor.
#pragma once

#include <memory>
#include <string>

#include "vehicle/multibody/system.hpp"
#include "vehicle/multibody/table.hpp"

namespace furrow::vehicle {

struct EngineOptions {
  Table full;               // torque at full throttle, N m against rad/s
  Table losses;             // drag, N m against rad/s; negative against a positive speed
  double idle_speed = 0.0;  // below which the governor opens the throttle, rad/s
  double idle_band = 10.0;  // over which it opens fully, rad/s
};

class Engine {
 public:
  /// @throws Error(physics) for a band that is not positive
  Engine(System& system, const std::string& name, int crank, const EngineOptions& options);

  void set_throttle(double throttle);  // 0 to 1
  double throttle() const { return *throttle_; }
  double torque(const System& system) const { return system.rate_state(row_).torque; }  // mean over the last step
  double work(const System& system) const { return system.rate_state(row_).work; }      // since the start, J

  void save(Archive& archive) const { archive.put("throttle", *throttle_); }
  void restore(const Archive& archive) { *throttle_ = archive.get_double("throttle"); }

 private:
  std::shared_ptr<double> throttle_ = std::make_shared<double>(0.0);  // shared with the law
  int row_ = 0;
};

}  // namespace furrow::vehicle
