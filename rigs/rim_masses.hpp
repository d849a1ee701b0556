// The masses of a rim that a scenario may leave to its tire, for every rig that carries single wheels.
#pragma once

#include <string>

#include "protocol/files/read_context.hpp"
#include "rigs/rig_spec.hpp"

namespace furrow::rigs {

/// What is negative is open.
struct RimMasses {
  double mass = -1.0;               // kg
  double spin_inertia = -1.0;       // kg m², about the axle
  double diametral_inertia = -1.0;  // kg m²
};

/// Whether a value is open.
inline bool is_open(double value) { return value < 0.0; }
/// Fills in an open value.
inline void take(double& value, double other) {
  if (is_open(value)) value = other;
}

/// What is open as the block `rim` of the tire's file says; the diametral inertia else half of the spin inertia.
RimMasses mounted_rim(RimMasses rim, const MountedTire& tire);

/// @throws Error(bad_input) naming the keys where neither scenario nor tire file say the rim's masses or, as
/// `load_missing` says, what the wheel carries. @param mass_key may be given in place of the load
void require_masses(const RimMasses& rim, bool load_missing, const char* mass_key, const MountedTire& tire,
                    const ReadContext& context);

}  // namespace furrow::rigs
