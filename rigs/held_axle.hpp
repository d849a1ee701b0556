// A drawbar rig whose axle is held from a time on.
#pragma once

#include <memory>

#include "rigs/drawbar_rig.hpp"

namespace furrow::rigs {

/// As make_drawbar_rig(), until a stop takes hold of the vertical slider where the wheel then stands on its load. What
/// speed the slider still has ends in the stop. @param hold_axle_from s, at touchdown_time or later
std::unique_ptr<Rig> make_held_drawbar_rig(const DrawbarRigOptions& options, double hold_axle_from);

}  // namespace furrow::rigs
