// A rigid lid that is pressed down on grains, and its vertical motion.
//
//   m v̇ = F − P − c v       v ← (v + dt (F − P)/m) / (1 + dt c/m),   z ← z + dt v
//
// F is the force of the grains (up), P the load (down). The lid has the mass of the soil under it and a damper with the
// soil's impedance, Z = √(ρ M) per area, with the modulus M ≈ E^{2/3} P^{1/3} of packed elastic spheres. So it comes to
// rest after about one swing, whatever the load.
#pragma once

#include <cmath>

#include "protocol/core/assert.hpp"
#include "terrain/dem/contact/laws.hpp"
#include "terrain/dem/dem_options.hpp"

namespace furrow::terrain::dem {

/// Young's modulus of the grains, Pa.
inline double grain_modulus(const DemOptions& o) {
  return with_law(law_from(o.law), [&](auto law) { return law.young_modulus(o); });
}

class LoadedLid {
 public:
  /// @param area m², @param pressure final one, Pa, @param density of the soil as a whole, kg/m³
  LoadedLid(double area, double pressure, double density, double depth, double young_modulus)
      : mass_(density * area * depth),
        damping_(area * std::sqrt(density * std::cbrt(young_modulus * young_modulus * pressure))) {}

  double velocity() const { return velocity_; }  // m/s, up

  /// @param force of the grains, up, N; @param load down, N. Returns the velocity for the coming step.
  double step(double force, double load, double dt) {
    FURROW_ASSERT(dt > 0.0, dt);
    velocity_ = (velocity_ + dt * (force - load) / mass_) / (1.0 + dt * damping_ / mass_);
    return velocity_;
  }

 private:
  double mass_, damping_;  // kg, N s/m
  double velocity_ = 0.0;
};

}  // namespace furrow::terrain::dem
