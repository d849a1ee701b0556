#include "rigs/drawbar_mount.hpp"

#include <cmath>

#include <fmt/format.h>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/json_text.hpp"
#include "rigs/lowering.hpp"
#include "rigs/ride_mount.hpp"
#include "rigs/rim_masses.hpp"

namespace furrow::rigs {
namespace {

/// Rim and carrier as far as the tire file says them.
void mount_masses(DrawbarRigOptions& rig, const MountedTire& tire, const ReadContext& context) {
  const RimMasses rim = mount_rim(rig, tire);
  if (is_open(rig.load)) take(rig.carrier_mass, tire.rim.carrier_mass);
  require_masses(rim, is_open(rig.load) && is_open(rig.carrier_mass), "carrier_mass", tire, context);
}

/// load = (carrier + rim + tire) g: the one that is open from the other.
void mount_load(DrawbarRigOptions& rig, const MountedTire& tire, const ReadContext& context, const std::string& wheel) {
  const double g = -rig.gravity.z(), rest = rig.rim_mass + tire.mass;
  if (is_open(rig.load)) {
    rig.load = (rig.carrier_mass + rest) * g;
    return;
  }
  rig.carrier_mass = rig.load / g - rest;
  if (!(rig.carrier_mass > 0.0))
    throw input_error(context.file, context.key(wheel + "load"),
                      fmt::format("is {} N, expected above {:.6g} N: rim ({} kg) and tire ({:.4g} kg) weigh that by "
                                  "themselves; see rig.rim_mass and the tire file",
                                  number_text(rig.load), rest * g, number_text(rig.rim_mass), tire.mass));
}

void mount_damper(DrawbarRigOptions& rig, const MountedTire& tire) {
  const double g = -rig.gravity.z();
  if (is_open(rig.touchdown_damping)) {
    take(rig.lowering_speed, kLoweringFroude * std::sqrt(g * tire.radius));
    rig.touchdown_damping = rig.load / rig.lowering_speed;
  }
  take(rig.touchdown_time, rig.move_from > 0.0 ? rig.move_from : kLoweringTime * std::sqrt(tire.radius / g));
}

}  // namespace

DrawbarRigOptions mounted(DrawbarRigOptions rig, const MountedTire& tire, const ReadContext& context,
                          const std::string& wheel) {
  FURROW_ASSERT(tire.radius > 0.0 && tire.mass >= 0.0, tire.radius, tire.mass);
  mount_masses(rig, tire, context);
  mount_load(rig, tire, context, wheel);
  mount_damper(rig, tire);
  return rig;
}

}  // namespace furrow::rigs
