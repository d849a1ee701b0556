// A rig whose wheels start at rig.start and roll along +x at rig.speed, as an entry of the table of rigs: the common
// part of quarter car, half car and cleat stand. `Options` is the struct of the rig's keys.
#pragma once

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "protocol/core/assert.hpp"
#include "protocol/files/read_context.hpp"
#include "rigs/mounting.hpp"
#include "rigs/rig_spec.hpp"
#include "rigs/section_keys.hpp"

namespace furrow::rigs {

template <class Options>
class RideSpec : public RigSpec {
 public:
  std::size_t wheel_count() const override { return offsets_.size(); }
  void mount(std::span<const MountedTire> tires) override {
    FURROW_ASSERT(tires.size() == offsets_.size(), tires.size(), offsets_.size());
    mount_tires(tires);
  }
  RigDescription describe(std::span<const WheelSize> tires, double duration) const override {
    FURROW_ASSERT(tires.size() == offsets_.size(), tires.size(), offsets_.size());
    RigDescription d;
    d.kind = kind_;
    d.text = text();
    d.speeds_up_until = rig_.move_from + rig_.ramp;
    d.speeds_up_key = rig_.move_from > 0.0 ? "rig.move_from + rig.ramp" : "rig.ramp";
    for (std::size_t k = 0; k < tires.size(); ++k) d.wheels.push_back(wheel(k, tires[k], duration));
    return d;
  }
  void fill_starts(std::span<const WheelSize> tires, double, std::optional<double> length,
                   std::span<const double> margins) override {
    if (start_given_) return;
    rig_.start = 0.0;
    for (std::size_t k = 0; length && k < tires.size(); ++k)
      rig_.start = std::max(rig_.start, tires[k].radius + tires[k].beyond + margins[k] - offsets_[k]);
  }

 protected:
  /// @param offsets of each axle ahead of rig.start, m
  RideSpec(const char* kind, std::vector<double> offsets, const Options& rig, const nlohmann::json& section,
           ReadContext context)
      : rig_(rig),
        context_(std::move(context)),
        kind_(kind),
        offsets_(std::move(offsets)),
        start_given_(says(section, "start")) {}

  /// Writes the filled-in values into the scenario's section, without those still open. A mass that follows from a
  /// stated load is not written. @param values kg, m, s
  void write(nlohmann::json& section, std::pair<const char*, double> mass,
             std::initializer_list<std::pair<const char*, double>> values) const {
    const auto fill = [&](const char* key, double value) {
      if (!is_open(value)) section[key] = value;
    };
    for (const auto& [key, value] : values) fill(key, value);
    fill("lowering_speed", rig_.lowering_speed);
    fill("rim_mass", rig_.rim_mass);
    fill("rim_spin_inertia", rig_.rim_spin_inertia);
    fill("rim_diametral_inertia", rig_.rim_diametral_inertia);
    if (!says(section, "load")) fill(mass.first, mass.second);
    section["start"] = rig_.start;
  }

  Options rig_;
  ReadContext context_;

 private:
  virtual void mount_tires(std::span<const MountedTire> tires) = 0;
  virtual std::string text() const = 0;
  /// Mass without the tire, kg.
  virtual double carried_mass(std::size_t k) const = 0;
  virtual double unsprung_mass(std::size_t k) const = 0;

  WheelDescription wheel(std::size_t k, const WheelSize& tire, double duration) const {
    WheelDescription wheel;
    const double moving = std::max(0.0, duration - rig_.move_from);
    if (offsets_.size() > 1) wheel.name = k == 0 ? "front" : "rear";
    wheel.start_offset = offsets_[k];
    wheel.from = rig_.start + offsets_[k];
    wheel.to = rig_.start + rig_.speed * (moving - 0.5 * std::min(rig_.ramp, moving)) + offsets_[k];
    wheel.along = tire.radius + tire.beyond;
    wheel.across = 0.5 * tire.width;
    wheel.carried_mass = carried_mass(k);
    wheel.unsprung_mass = unsprung_mass(k);
    wheel.spin_inertia = rig_.rim_spin_inertia;
    wheel.speed = wheel.tread_speed = rig_.speed;
    wheel.lowering_time = rig_.move_from;
    wheel.lowering_speed = rig_.lowering_speed;
    wheel.start_key = "rig.start";
    return wheel;
  }

  const char* kind_;
  std::vector<double> offsets_;
  bool start_given_;
};

// The common part of quarter car and half car.

inline constexpr double kUnsprungShare = 0.01;  // of the rim's mass, for the rest of the unsprung mass
/// A usual suspension: natural frequency of the body on a held wheel, and share of critical damping.
inline constexpr double kUsualBodyFrequency = 1.5, kUsualBodyDamping = 0.3;  // Hz; –

/// N/m
inline double usual_stiffness(double body_mass) {
  const double omega = 2.0 * std::numbers::pi * kUsualBodyFrequency;
  return body_mass * omega * omega;
}

/// N s/m
inline double usual_damping(double body_mass, double stiffness) {
  return 2.0 * kUsualBodyDamping * std::sqrt(body_mass * stiffness);
}

/// Mounts everything but the suspensions.
template <class Options>
void mount_car(Options& rig, std::span<const MountedTire> tires, const ReadContext& context) {
  mount_masses(rig, rig.body_mass, "body_mass", tires, context);
  take(rig.unsprung_mass, kUnsprungShare * rig.rim_mass);
  double rest = static_cast<double>(tires.size()) * (rig.unsprung_mass + rig.rim_mass), radius = 0.0;
  for (const MountedTire& tire : tires) {
    FURROW_ASSERT(tire.radius > 0.0 && tire.mass >= 0.0, tire.radius, tire.mass);
    rest += tire.mass;
    radius = std::max(radius, tire.radius);
  }
  mount_load(rig.load, rig.body_mass, rest,
             fmt::format("the weight of unsprung masses, rims and tires ({:.4g} kg) alone", rest), context);
  mount_lowering(rig, radius);
}

}  // namespace furrow::rigs
