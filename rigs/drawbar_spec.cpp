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
#include "rigs/rig_row.hpp"

namespace furrow::rigs {
namespace {

using nlohmann::json;

/// A wheel's rig, and whether the scenario says where its axle starts.
struct Place {
  DrawbarRigOptions rig;
  bool start_given = true;
  bool start_listed = false;  // by its own entry of rig.wheels
};

/// Of the axle's travel, m, forward positive.
double travel(const DrawbarRigOptions& rig, double tire_radius, double duration) {
  const double speed =
      rig.mode == "fixed_angular_speed" ? rig.angular_speed * tire_radius * (1.0 - rig.slip) : rig.speed;
  // Over the ramp the mean speed is half of the full one.
  const double ramped = std::min(rig.ramp, duration);
  return speed * (duration - 0.5 * ramped);
}

class DrawbarSpec final : public RigSpec {
 public:
  /// @param listed whether the wheels are entries of rig.wheels
  DrawbarSpec(std::vector<Place> places, bool listed) : places_(std::move(places)), listed_(listed) {
    FURROW_ASSERT(!places_.empty());
  }

  std::size_t wheel_count() const override { return places_.size(); }

  RigDescription describe(std::span<const WheelSize> tires, double duration) const override {
    FURROW_ASSERT(tires.size() == places_.size(), tires.size(), places_.size());
    const DrawbarRigOptions& first = places_.front().rig;
    RigDescription d;
    d.kind = places_.size() > 1 ? "drawbar row" : "drawbar";
    d.text = fmt::format("{} drawbar rig{}, {}", places_.size(), places_.size() > 1 ? "s" : "", first.mode);
    d.speeds_up_until = first.ramp;
    d.speeds_up_key = "rig.ramp";
    for (std::size_t k = 0; k < places_.size(); ++k) d.wheels.push_back(wheel(k, tires[k], duration));
    return d;
  }

  std::unique_ptr<Rig> make() const override {
    if (places_.size() == 1) return make_drawbar_rig(places_.front().rig);
    std::vector<std::unique_ptr<Rig>> rigs;
    for (const Place& place : places_) rigs.push_back(make_drawbar_rig(place.rig));
    return make_rig_row(std::move(rigs));
  }

  void fill_starts(std::span<const WheelSize> tires, double duration, std::optional<double> length,
                   double margin) override {
    for (std::size_t k = 0; k < places_.size(); ++k) {
      if (places_[k].start_given) continue;
      const WheelDescription d = wheel(k, tires[k], duration);
      const double reach = d.along + margin;
      places_[k].rig.start = !length ? 0.0 : d.to >= d.from ? reach : *length - reach;
    }
  }

  void complete(json& section) const override {
    section["start"] = places_.front().rig.start;
    for (std::size_t k = 0; listed_ && k < places_.size(); ++k)
      section["wheels"][k]["start"] = places_[k].rig.start;
  }

 private:
  WheelDescription wheel(std::size_t k, const WheelSize& tire, double duration) const {
    const DrawbarRigOptions& rig = places_[k].rig;
    WheelDescription d;
    d.lateral = rig.lateral;
    d.from = rig.start;
    d.to = rig.start + rig.travel_sign * travel(rig, tire.radius, duration);
    const double c = std::cos(rig.toe_angle), s = std::abs(std::sin(rig.toe_angle));
    const double half =
        0.5 * tire.width * std::cos(rig.camber_angle) + tire.radius * std::abs(std::sin(rig.camber_angle));
    d.along = tire.radius * c + half * s;
    if (rig.toe_time > 0.0) d.along = std::max(d.along, tire.radius);  // straight ahead at first
    d.across = half * c + tire.radius * s;
    d.toe_angle = rig.toe_angle;
    d.camber_angle = rig.camber_angle;
    d.slip = rig.slip;
    d.travel_sign = rig.travel_sign;
    d.carried_mass = rig.carrier_mass + rig.rim_mass;
    // Where several start, each in its own entry; of a single one it is where the value stands.
    const bool in_list = places_[k].start_listed || places_.size() > 1;
    d.start_key = listed_ && in_list ? fmt::format("rig.wheels.{}.start", k) : "rig.start";
    return d;
  }

  std::vector<Place> places_;
  bool listed_;
};

bool says(const json& section, const char* name) {
  const auto entry = section.find(name);
  return entry != section.end() && !entry->is_null();
}

}  // namespace

std::unique_ptr<RigSpec> read_drawbar(const json& section, const ReadContext& context) {
  DrawbarRigOptions common;
  read_fields(section, common);
  std::vector<Place> places;
  const json wheels = section.value("wheels", json::array());
  for (const json& entry : wheels) {
    DrawbarWheel wheel{common};
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
  return std::make_unique<DrawbarSpec>(std::move(places), !wheels.empty());
}

std::unique_ptr<RigSpec> drawbar_spec(std::vector<DrawbarRigOptions> rigs) {
  std::vector<Place> places;
  const bool listed = rigs.size() > 1;
  for (DrawbarRigOptions& rig : rigs) places.push_back({std::move(rig), true});
  return std::make_unique<DrawbarSpec>(std::move(places), listed);
}

}  // namespace furrow::rigs
