// Values that rigs of single wheels take from their tires if the scenario leaves them open; a negative value is open.
// `Options` is the struct of a rig's keys.
#pragma once

#include <cmath>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "protocol/core/constants.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/json_text.hpp"
#include "protocol/files/read_context.hpp"
#include "rigs/lowering.hpp"
#include "rigs/rig_spec.hpp"

namespace furrow::rigs {

inline constexpr double kRingInertia = 0.5;  // of a thin ring: inertia about a diameter over inertia about its axle

inline bool is_open(double value) { return value < 0.0; }
inline void take(double& value, double other) {
  if (is_open(value)) value = other;
}

/// Fills in the rims from the block `rim` of the first tire's file; the diametral inertia is otherwise half of the spin
/// inertia. If no load is given, the carried mass is the sum over all tires' files.
/// @param carried mass of the key `carried_key`, kg; it may be given instead of the load
/// @throws Error(bad_input) naming the keys if neither scenario nor tire file gives a mass
template <class Options>
void mount_masses(Options& rig, double& carried, const char* carried_key, std::span<const MountedTire> tires,
                  const ReadContext& context) {
  const MountedTire& first = tires.front();
  take(rig.rim_mass, first.rim.mass);
  take(rig.rim_spin_inertia, first.rim.spin_inertia);
  take(rig.rim_diametral_inertia, first.rim.diametral_inertia);
  take(rig.rim_diametral_inertia, kRingInertia * rig.rim_spin_inertia);
  bool given = true;
  double sum = 0.0;
  for (const MountedTire& tire : tires) {
    given = given && !is_open(tire.rim.carrier_mass);
    sum += tire.rim.carrier_mass;
  }
  if (is_open(rig.load) && given) take(carried, sum);
  std::vector<std::string> missing;
  if (is_open(rig.load) && is_open(carried)) missing.push_back(context.key("load"));
  if (is_open(rig.rim_mass)) missing.push_back(context.key("rim_mass"));
  if (is_open(rig.rim_spin_inertia)) missing.push_back(context.key("rim_spin_inertia"));
  if (missing.empty()) return;
  const std::span others = std::span(missing).subspan(1);
  throw input_error(context.file, missing.front(),
                    fmt::format("is missing{}{}, expected here (or {} in place of {}), or as mass, spin_inertia and "
                                "carrier_mass in a block 'rim' of the tire file {}",
                                others.empty() ? "" : " and so is ", fmt::join(others, ", "), context.key(carried_key),
                                context.key("load"), first.file));
}

/// load = (carried + rest) g: computes the open one from the other. @param key of the load @param rest kg @param
/// rest_text names the rest in the message. @throws Error(bad_input) if the load is too small for the rest
inline void mount_load(double& load, double& carried, double rest, const std::string& rest_text,
                       const ReadContext& context, const std::string& key = "load") {
  if (is_open(load)) {
    load = (carried + rest) * kStandardGravity;
    return;
  }
  carried = load / kStandardGravity - rest;
  if (!(carried > 0.0))
    throw input_error(
        context.file, context.key(key),
        fmt::format("is {} N, expected above {:.6g} N: {}", number_text(load), rest * kStandardGravity, rest_text));
}

/// Fills in how the wheels are lowered. @param radius of the largest tire, m
template <class Options>
void mount_lowering(Options& rig, double radius) {
  take(rig.lowering_speed, kLoweringFroude * std::sqrt(kStandardGravity * radius));
  take(rig.touchdown_time, rig.move_from > 0.0 ? rig.move_from : kLoweringTime * std::sqrt(radius / kStandardGravity));
}

}  // namespace furrow::rigs
