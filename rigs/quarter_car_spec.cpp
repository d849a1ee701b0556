#include "rigs/quarter_car_spec.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/json_fields.hpp"
#include "protocol/files/json_text.hpp"
#include "rigs/lowering.hpp"
#include "vehicle/analysis/quarter_car.hpp"

namespace furrow::rigs {
namespace {

using nlohmann::json;

constexpr double kRingInertia = 0.5;     // of a thin ring about a diameter, of that about its axle
constexpr double kUnsprungShare = 0.01;  // of the rim

bool open(double value) { return value < 0.0; }

void take(double& value, double other) {
  if (open(value)) value = other;
}

bool says(const json& section, const char* name) {
  const auto entry = section.find(name);
  return entry != section.end() && !entry->is_null();
}

class QuarterCarSpec final : public RigSpec {
 public:
  QuarterCarSpec(const QuarterCarOptions& rig, bool start_given, ReadContext context)
      : rig_(rig), start_given_(start_given), context_(std::move(context)) {}

  std::size_t wheel_count() const override { return 1; }
  void mount(std::span<const MountedTire> tires) override {
    FURROW_ASSERT(tires.size() == 1, tires.size());
    rig_ = mounted(rig_, tires[0], context_);
  }

  RigDescription describe(std::span<const WheelSize> tires, double duration) const override {
    FURROW_ASSERT(tires.size() == 1, tires.size());
    RigDescription d;
    d.kind = "quarter_car";
    d.text = fmt::format("1 quarter car, body {:.5g} kg on {:.4g} N/m and {:.4g} N s/m", rig_.body_mass,
                         rig_.suspension_stiffness, rig_.suspension_damping);
    d.speeds_up_until = rig_.move_from + rig_.ramp;
    d.speeds_up_key = rig_.move_from > 0.0 ? "rig.move_from + rig.ramp" : "rig.ramp";
    WheelDescription wheel;
    wheel.from = rig_.start;
    const double moving = std::max(0.0, duration - rig_.move_from);
    wheel.to = rig_.start + rig_.speed * (moving - 0.5 * std::min(rig_.ramp, moving));
    wheel.along = tires[0].radius;
    wheel.across = 0.5 * tires[0].width;
    wheel.carried_mass = rig_.body_mass + rig_.unsprung_mass + rig_.rim_mass;
    wheel.speed = wheel.tread_speed = rig_.speed;
    wheel.lowering_time = rig_.move_from;
    wheel.lowering_speed = rig_.lowering_speed;
    wheel.start_key = "rig.start";
    d.wheels = {wheel};
    return d;
  }

  std::unique_ptr<Rig> make() const override { return make_quarter_car(rig_); }

  void fill_starts(std::span<const WheelSize> tires, double, std::optional<double> length,
                   std::span<const double> margins) override {
    if (!start_given_) rig_.start = length ? tires[0].radius + margins[0] : 0.0;
  }

  void complete(json& section) const override {
    for (const auto& [key, value] : {std::pair{"unsprung_mass", rig_.unsprung_mass},
                                     {"suspension_stiffness", rig_.suspension_stiffness},
                                     {"suspension_damping", rig_.suspension_damping},
                                     {"rim_mass", rig_.rim_mass},
                                     {"rim_spin_inertia", rig_.rim_spin_inertia},
                                     {"rim_diametral_inertia", rig_.rim_diametral_inertia},
                                     {"touchdown_time", rig_.touchdown_time},
                                     {"lowering_speed", rig_.lowering_speed},
                                     {"start", rig_.start}})
      if (value >= 0.0 || std::string(key) == "start") section[key] = value;
    if (!says(section, "load") && rig_.body_mass >= 0.0) section["body_mass"] = rig_.body_mass;
  }

 private:
  QuarterCarOptions rig_;
  bool start_given_;
  ReadContext context_;
};

}  // namespace

QuarterCarOptions mounted(QuarterCarOptions rig, const MountedTire& tire, const ReadContext& context) {
  FURROW_ASSERT(tire.radius > 0.0 && tire.mass >= 0.0, tire.radius, tire.mass);
  take(rig.rim_mass, tire.rim.mass);
  take(rig.rim_spin_inertia, tire.rim.spin_inertia);
  take(rig.rim_diametral_inertia, tire.rim.diametral_inertia);
  take(rig.rim_diametral_inertia, kRingInertia * rig.rim_spin_inertia);
  if (open(rig.load)) take(rig.body_mass, tire.rim.carrier_mass);
  std::vector<std::string> missing;
  if (open(rig.load) && open(rig.body_mass)) missing.push_back(context.key("load"));
  if (open(rig.rim_mass)) missing.push_back(context.key("rim_mass"));
  if (open(rig.rim_spin_inertia)) missing.push_back(context.key("rim_spin_inertia"));
  if (!missing.empty()) {
    const std::string first = missing.front();
    missing.erase(missing.begin());
    throw input_error(
        context.file, first,
        fmt::format("is missing{}{}, expected here ({} in place of {} if you like), or as mass, spin_inertia and "
                    "carrier_mass in a block 'rim' of the tire file {}",
                    missing.empty() ? "" : " and so is ", fmt::join(missing, ", "), context.key("body_mass"),
                    context.key("load"), tire.file));
  }
  take(rig.unsprung_mass, kUnsprungShare * rig.rim_mass);
  const double rest = rig.unsprung_mass + rig.rim_mass + tire.mass;
  if (open(rig.load)) {
    rig.load = (rig.body_mass + rest) * kStandardGravity;
  } else {
    rig.body_mass = rig.load / kStandardGravity - rest;
    if (!(rig.body_mass > 0.0))
      throw input_error(context.file, context.key("load"),
                        fmt::format("is {} N, expected above {:.6g} N: what is unsprung ({:.4g} kg), rim ({:.4g} "
                                    "kg) and tire ({:.4g} kg) weigh that by themselves",
                                    number_text(rig.load), rest * kStandardGravity, rig.unsprung_mass,
                                    rig.rim_mass, tire.mass));
  }
  take(rig.suspension_stiffness, vehicle::usual_stiffness(rig.body_mass));
  take(rig.suspension_damping, vehicle::usual_damping(rig.body_mass, rig.suspension_stiffness));
  take(rig.lowering_speed, kLoweringFroude * std::sqrt(kStandardGravity * tire.radius));
  take(rig.touchdown_time,
       rig.move_from > 0.0 ? rig.move_from : kLoweringTime * std::sqrt(tire.radius / kStandardGravity));
  return rig;
}

std::unique_ptr<RigSpec> read_quarter_car(const json& section, const ReadContext& context) {
  QuarterCarOptions rig;
  read_fields(section, rig);
  if (says(section, "load") && says(section, "body_mass"))
    throw input_error(
        context.file, context.key("load"),
        fmt::format("is given beside '{}', expected one of the two", context.key("body_mass")));
  return std::make_unique<QuarterCarSpec>(rig, says(section, "start"), context);
}

}  // namespace furrow::rigs
