#include "rigs/drawbar_spec.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/json_fields.hpp"
#include "protocol/files/json_text.hpp"
#include "rigs/drawbar_mount.hpp"
#include "rigs/rig_row.hpp"
#include "rigs/section_keys.hpp"

namespace furrow::rigs {
namespace {

using nlohmann::json;

/// A wheel's rig, and whether the scenario gives the start of its axle.
struct Place {
  DrawbarRigOptions rig;
  bool start_given = true;
  bool start_listed = false;  // in its own entry of rig.wheels
};

/// Speed of the axle after the ramp, m/s, forward positive.
double full_speed(const DrawbarRigOptions& rig, double tire_radius) {
  return rig.mode == "fixed_angular_speed" ? rig.angular_speed * tire_radius * (1.0 - rig.slip) : rig.speed;
}

/// Speed of the tread against the axle after the ramp, m/s, forward positive.
double tread_speed(const DrawbarRigOptions& rig, double tire_radius) {
  if (rig.mode == "fixed_angular_speed") return rig.angular_speed * tire_radius;
  return rig.mode == "free_rolling" ? rig.speed : rig.speed / (1.0 - rig.slip);
}

/// Travel of the axle, m, forward positive.
double travel(const DrawbarRigOptions& rig, double tire_radius, double duration) {
  // Over the ramp the mean speed is half of the full one.
  const double moving = std::max(0.0, duration - rig.move_from), ramped = std::min(rig.ramp, moving);
  return full_speed(rig, tire_radius) * (moving - 0.5 * ramped);
}

class DrawbarSpec final : public RigSpec {
 public:
  /// @param listed whether the wheels are entries of rig.wheels
  DrawbarSpec(std::vector<Place> places, bool listed, ReadContext context)
      : places_(std::move(places)), listed_(listed), context_(std::move(context)) {
    FURROW_ASSERT(!places_.empty());
  }

  std::size_t wheel_count() const override { return places_.size(); }

  void mount(std::span<const MountedTire> tires) override {
    FURROW_ASSERT(tires.size() == places_.size(), tires.size(), places_.size());
    for (std::size_t k = 0; k < places_.size(); ++k)
      places_[k].rig = mounted(places_[k].rig, tires[k], context_, wheel_key(k));
  }

  RigDescription describe(std::span<const WheelSize> tires, double duration) const override {
    FURROW_ASSERT(tires.size() == places_.size(), tires.size(), places_.size());
    const DrawbarRigOptions& first = places_.front().rig;
    RigDescription d;
    d.kind = places_.size() > 1 ? "drawbar row" : "drawbar";
    d.text = fmt::format("{} drawbar rig{}, {}", places_.size(), places_.size() > 1 ? "s" : "", first.mode);
    d.speeds_up_until = first.move_from + first.ramp;
    d.speeds_up_key = first.move_from > 0.0 ? "rig.move_from + rig.ramp" : "rig.ramp";
    for (std::size_t k = 0; k < places_.size(); ++k) d.wheels.push_back(wheel(k, tires[k], duration));
    return d;
  }

  std::unique_ptr<Rig> make() const override {
    if (places_.size() == 1) return make_drawbar_rig(places_.front().rig);
    std::vector<std::unique_ptr<Rig>> rigs;
    for (const Place& place : places_) rigs.push_back(make_drawbar_rig(place.rig));
    return make_rig_row(std::move(rigs));
  }

  std::vector<std::pair<std::string, std::string>> unlikely_values() const override {
    const DrawbarRigOptions usual;
    const std::string& mode = places_.front().rig.mode;
    const bool free = mode == "free_rolling";  // a study may state slip 0 for it
    std::vector<std::pair<std::string, std::string>> odd;
    const auto unused = [&](const char* key, const char* unit, double DrawbarRigOptions::*value, const char* what) {
      const auto stated = [&](double given) { return given != usual.*value && !(free && given == 0.0); };
      std::size_t k = 0;
      while (k < places_.size() && !stated(places_[k].rig.*value)) ++k;
      if (k == places_.size()) return;
      odd.emplace_back(context_.key((same(value) ? "" : wheel_key(k)) + key),
                       fmt::format("is {}{} and is not used in mode {}, where {}: another rig.mode?",
                                   number_text(places_[k].rig.*value), unit, mode, what));
    };
    const char* const moves = "the carriage moves at angular_speed · R · (1 − slip)";
    const char* const turns = "the wheel turns at speed / (R · (1 − slip))";
    const char* const rolls = "the carriage moves at speed and the ground turns the wheel";
    if (free) unused("slip", "", &DrawbarRigOptions::slip, rolls);
    if (mode == "fixed_angular_speed")
      unused("speed", " m/s", &DrawbarRigOptions::speed, moves);
    else
      unused("angular_speed", " rad/s", &DrawbarRigOptions::angular_speed, free ? rolls : turns);
    return odd;
  }

  void fill_starts(std::span<const WheelSize> tires, double duration, std::optional<double> length,
                   std::span<const double> margins) override {
    FURROW_ASSERT(margins.size() == places_.size(), margins.size(), places_.size());
    for (std::size_t k = 0; k < places_.size(); ++k) {
      if (places_[k].start_given) continue;
      const WheelDescription d = wheel(k, tires[k], duration);
      const double reach = d.along + margins[k];
      places_[k].rig.start = !length ? 0.0 : d.to >= d.from ? reach : *length - reach;
    }
  }

  /// Writes the values that all wheels share, but none that follows from a stated load or speed.
  void complete(json& section) const override {
    bool by_load = says(section, "load");
    for (const json& entry : section.value("wheels", json::array())) by_load |= says(entry, "load");
    fill(section, "rim_mass", &DrawbarRigOptions::rim_mass);
    fill(section, "rim_spin_inertia", &DrawbarRigOptions::rim_spin_inertia);
    fill(section, "rim_diametral_inertia", &DrawbarRigOptions::rim_diametral_inertia);
    fill(section, "touchdown_time", &DrawbarRigOptions::touchdown_time);
    if (!by_load) fill(section, "carrier_mass", &DrawbarRigOptions::carrier_mass);
    if (!says(section, "lowering_speed")) fill(section, "touchdown_damping", &DrawbarRigOptions::touchdown_damping);
    section["start"] = places_.front().rig.start;
    for (std::size_t k = 0; listed_ && k < places_.size(); ++k) section["wheels"][k]["start"] = places_[k].rig.start;
  }

 private:
  WheelDescription wheel(std::size_t k, const WheelSize& tire, double duration) const {
    const DrawbarRigOptions& rig = places_[k].rig;
    WheelDescription d;
    d.lateral = rig.lateral;
    d.from = rig.start;
    d.to = rig.start + rig.travel_sign * travel(rig, tire.radius, duration);
    const double c = std::cos(rig.toe_angle), s = std::abs(std::sin(rig.toe_angle));
    const double reach = tire.radius + tire.beyond,
                 half = 0.5 * tire.width * std::cos(rig.camber_angle) + reach * std::abs(std::sin(rig.camber_angle));
    d.along = reach * c + half * s;
    if (rig.toe_time > 0.0) d.along = std::max(d.along, reach);  // straight ahead at first
    d.across = half * c + reach * s;
    d.toe_angle = rig.toe_angle;
    d.camber_angle = rig.camber_angle;
    if (rig.mode != "free_rolling") d.slip = rig.slip;
    d.travel_sign = rig.travel_sign;
    d.carried_mass = d.unsprung_mass = rig.carrier_mass + rig.rim_mass;
    if (rig.mode == "free_rolling") d.spin_inertia = rig.rim_spin_inertia;  // else its spin is imposed
    d.speed = full_speed(rig, tire.radius);
    d.tread_speed = tread_speed(rig, tire.radius);
    d.lowering_time = rig.move_from;
    if (rig.touchdown_damping > 0.0) d.lowering_speed = rig.load / rig.touchdown_damping;
    // With several wheels, each has its start in its own entry. A single wheel may have it there or in `rig`.
    const bool in_list = places_[k].start_listed || places_.size() > 1;
    d.start_key = listed_ && in_list ? fmt::format("rig.wheels.{}.start", k) : "rig.start";
    return d;
  }

  void fill(json& section, const char* key, double DrawbarRigOptions::*value) const {
    const double first = places_.front().rig.*value;
    if (first >= 0.0 && same(value)) section[key] = first;
  }

  bool same(double DrawbarRigOptions::*value) const {
    const double first = places_.front().rig.*value;
    return std::ranges::all_of(places_, [&](const Place& place) { return place.rig.*value == first; });
  }

  /// Prefix of the keys of wheel k within the section.
  std::string wheel_key(std::size_t k) const {
    return listed_ && places_.size() > 1 ? fmt::format("wheels.{}.", k) : "";
  }

  std::vector<Place> places_;
  bool listed_;
  ReadContext context_;
};

}  // namespace

std::unique_ptr<RigSpec> read_drawbar(const json& section, const ReadContext& context) {
  DrawbarRigOptions common;
  read_fields(section, common);
  refuse_both(section, "load", "carrier_mass", context);
  refuse_both(section, "lowering_speed", "touchdown_damping", context);
  std::vector<Place> places;
  const json wheels = section.value("wheels", json::array());
  for (const json& entry : wheels) {
    refuse_both(entry, "load", "carrier_mass", context, fmt::format("wheels.{}.", places.size()));
    DrawbarWheel wheel{common};
    if (says(entry, "load") || says(entry, "carrier_mass")) wheel.rig.load = wheel.rig.carrier_mass = -1.0;
    read_fields(entry, wheel);
    places.push_back({wheel.rig, says(section, "start") || says(entry, "start"), says(entry, "start")});
  }
  if (wheels.empty()) places.push_back({common, says(section, "start")});
  for (std::size_t k = 0; k < places.size(); ++k)
    if (const DrawbarRigOptions& rig = places[k].rig; rig.mode == "fixed_speed" && rig.slip >= 1.0)
      throw input_error(
          context.file,
          context.key(!wheels.empty() && says(wheels[k], "slip") ? fmt::format("wheels.{}.slip", k) : "slip"),
          fmt::format("is {}, expected below 1 in mode fixed_speed: a carriage that moves cannot slip fully",
                      number_text(rig.slip)));
  return std::make_unique<DrawbarSpec>(std::move(places), !wheels.empty(), context);
}

std::unique_ptr<RigSpec> drawbar_spec(std::vector<DrawbarRigOptions> rigs) {
  std::vector<Place> places;
  const bool listed = rigs.size() > 1;
  for (DrawbarRigOptions& rig : rigs) places.push_back({std::move(rig), true});
  return std::make_unique<DrawbarSpec>(std::move(places), listed, ReadContext{"scenario", "rig"});
}

}  // namespace furrow::rigs
