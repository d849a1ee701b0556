// The masses and the damper of the rig of the 2016 SBEL report, for tests that need a rig.
#pragma once

#include "rigs/drawbar_rig.hpp"

namespace furrow::testing {

inline rigs::DrawbarRigOptions reference_options() {
  rigs::DrawbarRigOptions options;
  options.carrier_mass = 450.0;
  options.rim_mass = 15.0;
  options.rim_spin_inertia = 0.7;
  options.rim_diametral_inertia = 0.4;
  options.touchdown_damping = 12e3;
  options.touchdown_time = 0.35;
  return options;
}

}  // namespace furrow::testing
