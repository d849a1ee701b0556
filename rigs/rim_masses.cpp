#include "rigs/rim_masses.hpp"

#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "protocol/core/error.hpp"

namespace furrow::rigs {
namespace {

constexpr double kRingInertia = 0.5;  // of a thin ring about a diameter, of that about its axle

}  // namespace

RimMasses mounted_rim(RimMasses rim, const MountedTire& tire) {
  take(rim.mass, tire.rim.mass);
  take(rim.spin_inertia, tire.rim.spin_inertia);
  take(rim.diametral_inertia, tire.rim.diametral_inertia);
  take(rim.diametral_inertia, kRingInertia * rim.spin_inertia);
  return rim;
}

void require_masses(const RimMasses& rim, bool load_missing, const char* mass_key, const MountedTire& tire,
                    const ReadContext& context) {
  std::vector<std::string> missing;
  if (load_missing) missing.push_back(context.key("load"));
  if (is_open(rim.mass)) missing.push_back(context.key("rim_mass"));
  if (is_open(rim.spin_inertia)) missing.push_back(context.key("rim_spin_inertia"));
  if (missing.empty()) return;
  const std::string first = missing.front();
  missing.erase(missing.begin());
  throw input_error(
      context.file, first,
      fmt::format("is missing{}{}, expected here ({} in place of {} if you like), or as mass, spin_inertia and "
                  "carrier_mass in a block 'rim' of the tire file {}",
                  missing.empty() ? "" : " and so is ", fmt::join(missing, ", "), context.key(mass_key),
                  context.key("load"), tire.file));
}

}  // namespace furrow::rigs
