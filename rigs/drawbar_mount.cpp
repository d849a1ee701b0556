#include "rigs/drawbar_mount.hpp"

#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/json_text.hpp"
#include "rigs/lowering.hpp"

namespace furrow::rigs {
namespace {

constexpr double kRingInertia = 0.5;  // of a thin ring about a diameter, of that about its axle

bool open(double value) { return value < 0.0; }

void take(double& value, double of_file) {
  if (open(value)) value = of_file;
}

/// Rim and carrier as far as the tire file says them.
void mount_masses(DrawbarRigOptions& rig, const MountedTire& tire, const ReadContext& context) {
  take(rig.rim_mass, tire.rim.mass);
  take(rig.rim_spin_inertia, tire.rim.spin_inertia);
  take(rig.rim_diametral_inertia, tire.rim.diametral_inertia);
  take(rig.rim_diametral_inertia, kRingInertia * rig.rim_spin_inertia);
  if (open(rig.load)) take(rig.carrier_mass, tire.rim.carrier_mass);
  std::vector<std::string> missing;
  if (open(rig.load) && open(rig.carrier_mass)) missing.push_back(context.key("load"));
  if (open(rig.rim_mass)) missing.push_back(context.key("rim_mass"));
  if (open(rig.rim_spin_inertia)) missing.push_back(context.key("rim_spin_inertia"));
  if (missing.empty()) return;
  const std::string first = missing.front();
  missing.erase(missing.begin());
  throw input_error(
      context.file, first,
      fmt::format(
          "is missing{}{}, expected here ({} in place of {} if you like), or as mass, spin_inertia and "
          "carrier_mass in a block 'rim' of the tire file {}",
          missing.empty() ? "" : " and so is ", fmt::join(missing, ", "), context.key("carrier_mass"),
          context.key("load"), tire.file));
}

/// load = (carrier + rim + tire) g: the one that is open from the other.
void mount_load(DrawbarRigOptions& rig, const MountedTire& tire, const ReadContext& context,
                const std::string& wheel) {
  const double g = -rig.gravity.z(), rest = rig.rim_mass + tire.mass;
  if (open(rig.load)) {
    rig.load = (rig.carrier_mass + rest) * g;
    return;
  }
  rig.carrier_mass = rig.load / g - rest;
  if (!(rig.carrier_mass > 0.0))
    throw input_error(
        context.file, context.key(wheel + "load"),
        fmt::format("is {} N, expected above {:.6g} N: rim ({} kg) and tire ({:.4g} kg) weigh that by "
                    "themselves; see rig.rim_mass and the tire file",
                    number_text(rig.load), rest * g, number_text(rig.rim_mass), tire.mass));
}

void mount_damper(DrawbarRigOptions& rig, const MountedTire& tire) {
  const double g = -rig.gravity.z();
  if (open(rig.touchdown_damping)) {
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
