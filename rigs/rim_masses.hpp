// The masses of a rim that a scenario may leave to its tire, for every rig that carries single wheels.
#pragma once

#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "protocol/core/error.hpp"
#include "protocol/files/read_context.hpp"
#include "rigs/rig_spec.hpp"

namespace furrow::rigs {

inline constexpr double kRingInertia = 0.5;  // of a thin ring about a diameter, of that about its axle

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
inline RimMasses mounted_rim(RimMasses rim, const MountedTire& tire) {
  take(rim.mass, tire.rim.mass);
  take(rim.spin_inertia, tire.rim.spin_inertia);
  take(rim.diametral_inertia, tire.rim.diametral_inertia);
  take(rim.diametral_inertia, kRingInertia * rim.spin_inertia);
  return rim;
}

/// @throws Error(bad_input) naming the keys where neither scenario nor tire file say the rim's masses or, as
/// `load_missing` says, what the wheel carries. @param mass_key may be given in place of the load
inline void require_masses(const RimMasses& rim, bool load_missing, const char* mass_key, const MountedTire& tire,
                           const ReadContext& context) {
  std::vector<std::string> missing;
  if (load_missing) missing.push_back(context.key("load"));
  if (is_open(rim.mass)) missing.push_back(context.key("rim_mass"));
  if (is_open(rim.spin_inertia)) missing.push_back(context.key("rim_spin_inertia"));
  if (missing.empty()) return;
  const std::string first = missing.front();
  missing.erase(missing.begin());
  throw input_error(context.file, first,
                    fmt::format("is missing{}{}, expected here (or {} in place of {}), or as mass, spin_inertia and "
                                "carrier_mass in a block 'rim' of the tire file {}",
                                missing.empty() ? "" : " and so is ", fmt::join(missing, ", "), context.key(mass_key),
                                context.key("load"), tire.file));
}

}  // namespace furrow::rigs
