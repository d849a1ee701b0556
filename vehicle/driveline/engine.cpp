#include "vehicle/driveline/engine.hpp"

#include <algorithm>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"

namespace furrow::vehicle {

Engine::Engine(System& system, const std::string& name, int crank, const EngineOptions& options) {
  if (!(options.idle_band > 0.0)) throw physics_error("engine '" + name + "': its idle band must be positive");
  row_ = system.add_rate_law(
      RateRow{name, {{crank, 1.0}}, {}},
      [o = options, throttle = throttle_](std::span<const double> speeds, double, std::span<ElementForce> torques) {
        const double u = speeds[0];
        const double governor = std::clamp((o.idle_speed - u) / o.idle_band, 0.0, 1.0);
        const double share = std::max(*throttle, governor);
        double slope = share * o.full.slope(u) + o.losses.slope(u);
        if (governor > *throttle && governor < 1.0) slope -= o.full.value(u) / o.idle_band;
        torques[0] = {share * o.full.value(u) + o.losses.value(u), std::max(0.0, -slope)};
      });
}

void Engine::set_throttle(double throttle) {
  FURROW_ASSERT(throttle >= 0.0 && throttle <= 1.0, throttle);
  *throttle_ = throttle;
}

}  // namespace furrow::vehicle
