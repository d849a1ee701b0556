#include "rigs/drawbar_mount.hpp"

#include <fmt/format.h>

#include "protocol/core/assert.hpp"
#include "protocol/files/json_text.hpp"
#include "rigs/mounting.hpp"

namespace furrow::rigs {

DrawbarRigOptions mounted(DrawbarRigOptions rig, const MountedTire& tire, const ReadContext& context,
                          const std::string& wheel) {
  FURROW_ASSERT(tire.radius > 0.0 && tire.mass >= 0.0, tire.radius, tire.mass);
  mount_masses(rig, rig.carrier_mass, "carrier_mass", {&tire, 1}, context);
  mount_load(
      rig.load, rig.carrier_mass, rig.rim_mass + tire.mass,
      fmt::format("rim ({} kg) and tire ({:.4g} kg) weigh that by themselves; see rig.rim_mass and the tire file",
                  number_text(rig.rim_mass), tire.mass),
      context, wheel + "load");
  mount_lowering(rig, tire.radius);
  take(rig.touchdown_damping, rig.load / rig.lowering_speed);
  return rig;
}

}  // namespace furrow::rigs
