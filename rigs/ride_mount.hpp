// What quarter car and half car have in common where their scenarios are read and completed. `Options` is either's
// struct.
#pragma once

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "protocol/core/constants.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/json_text.hpp"
#include "protocol/files/read_context.hpp"
#include "rigs/lowering.hpp"
#include "rigs/rig_spec.hpp"
#include "rigs/rim_masses.hpp"

namespace furrow::rigs {

inline constexpr double kUnsprungShare = 0.01;  // of the rim, for the rest of what is unsprung

/// Whether a section gives a key.
inline bool says(const nlohmann::json& section, const char* name) {
  const auto entry = section.find(name);
  return entry != section.end() && !entry->is_null();
}

/// @throws Error(bad_input)
inline void refuse_load_beside_body(const nlohmann::json& section, const ReadContext& context) {
  if (says(section, "load") && says(section, "body_mass"))
    throw input_error(context.file, context.key("load"),
                      fmt::format("is given beside '{}', expected one of the two", context.key("body_mass")));
}

/// Fills in what is open of the rim. @returns it, for require_masses()
template <class Options>
RimMasses mount_rim(Options& rig, const MountedTire& tire) {
  const RimMasses rim = mounted_rim({rig.rim_mass, rig.rim_spin_inertia, rig.rim_diametral_inertia}, tire);
  rig.rim_mass = rim.mass, rig.rim_spin_inertia = rim.spin_inertia;
  rig.rim_diametral_inertia = rim.diametral_inertia;
  return rim;
}

/// load = (body + rest) g: the one that is open from the other. @param rest what is unsprung, rims and tires, kg
/// @throws Error(bad_input) where the load is too small for the rest
template <class Options>
void mount_body(Options& rig, double rest, const ReadContext& context) {
  if (is_open(rig.load)) {
    rig.load = (rig.body_mass + rest) * kStandardGravity;
    return;
  }
  rig.body_mass = rig.load / kStandardGravity - rest;
  if (!(rig.body_mass > 0.0))
    throw input_error(context.file, context.key("load"),
                      fmt::format("is {} N, expected above {:.6g} N: the weight of unsprung masses, rims and tires "
                                  "({:.4g} kg) alone",
                                  number_text(rig.load), rest * kStandardGravity, rest));
}

/// How the wheels are let down. @param radius of the largest tire, m
template <class Options>
void mount_lowering(Options& rig, double radius) {
  take(rig.lowering_speed, kLoweringFroude * std::sqrt(kStandardGravity * radius));
  take(rig.touchdown_time, rig.move_from > 0.0 ? rig.move_from : kLoweringTime * std::sqrt(radius / kStandardGravity));
}

/// Writes what was filled in into the scenario's section, without what is still open. A mass that follows from a stated
/// load is not written.
/// @param values kg, m, s
inline void write_filled(nlohmann::json& section, std::initializer_list<std::pair<const char*, double>> values,
                         std::pair<const char*, double> mass, double start) {
  const auto write = [&](const std::pair<const char*, double>& entry) {
    if (!is_open(entry.second)) section[entry.first] = entry.second;
  };
  for (const auto& entry : values) write(entry);
  if (!says(section, "load")) write(mass);
  section["start"] = start;
}

/// The same for a rig of a body on suspensions. @param values that it has beside what both cars have
template <class Options>
void write_car(nlohmann::json& section, const Options& rig,
               std::initializer_list<std::pair<const char*, double>> values = {}) {
  write_filled(section,
               {{"unsprung_mass", rig.unsprung_mass},
                {"suspension_stiffness", rig.suspension_stiffness},
                {"suspension_damping", rig.suspension_damping},
                {"rim_mass", rig.rim_mass},
                {"rim_spin_inertia", rig.rim_spin_inertia},
                {"rim_diametral_inertia", rig.rim_diametral_inertia},
                {"touchdown_time", rig.touchdown_time},
                {"lowering_speed", rig.lowering_speed}},
               {"body_mass", rig.body_mass}, rig.start);
  for (const auto& [key, value] : values)
    if (!is_open(value)) section[key] = value;
}

/// A wheel that starts at rig.start, without what it carries.
template <class Options>
WheelDescription ride_wheel(const Options& rig, const WheelSize& tire, double duration) {
  WheelDescription wheel;
  wheel.from = rig.start;
  const double moving = std::max(0.0, duration - rig.move_from);
  wheel.to = rig.start + rig.speed * (moving - 0.5 * std::min(rig.ramp, moving));
  wheel.along = tire.radius;
  wheel.across = 0.5 * tire.width;
  wheel.speed = wheel.tread_speed = rig.speed;
  wheel.lowering_time = rig.move_from;
  wheel.lowering_speed = rig.lowering_speed;
  wheel.start_key = "rig.start";
  return wheel;
}

}  // namespace furrow::rigs
