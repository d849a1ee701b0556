#include "rigs/cleat_stand_spec.hpp"

#include <string>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/json_fields.hpp"
#include "rigs/drawbar_mount.hpp"
#include "rigs/ride_mount.hpp"

namespace furrow::rigs {
namespace {

using nlohmann::json;

DrawbarRigOptions drawbar_of(const CleatStandOptions& stand) {
  DrawbarRigOptions rig;
  rig.mode = "free_rolling";
  rig.slip = 0.0;
  rig.speed = stand.speed;
  rig.ramp = stand.ramp;
  rig.move_from = stand.move_from;
  rig.touchdown_time = stand.hold_axle_from;
  rig.lowering_speed = stand.lowering_speed;
  rig.start = stand.start;
  rig.load = stand.load;
  rig.carrier_mass = stand.carrier_mass;
  rig.rim_mass = stand.rim_mass;
  rig.rim_spin_inertia = stand.rim_spin_inertia;
  rig.rim_diametral_inertia = stand.rim_diametral_inertia;
  return rig;
}

class CleatStandSpec final : public RigSpec {
 public:
  CleatStandSpec(const CleatStandOptions& stand, bool start_given, ReadContext context)
      : rig_(drawbar_of(stand)),
        hold_from_(stand.hold_axle_from),
        start_given_(start_given),
        context_(std::move(context)) {}

  std::size_t wheel_count() const override { return 1; }
  void mount(std::span<const MountedTire> tires) override {
    FURROW_ASSERT(tires.size() == 1, tires.size());
    rig_ = mounted(rig_, tires[0], context_, "");
  }

  RigDescription describe(std::span<const WheelSize> tires, double duration) const override {
    FURROW_ASSERT(tires.size() == 1, tires.size());
    if (hold_from_ >= duration)
      throw input_error(context_.file, context_.key("hold_axle_from"),
                        fmt::format("is {:g} s, expected a time before the run ends at {:g} s", hold_from_, duration));
    RigDescription d;
    d.kind = "cleat_stand";
    d.text = fmt::format("1 cleat test stand, axle held from {:.4g} s on", hold_from_);
    d.speeds_up_until = rig_.move_from + rig_.ramp;
    d.speeds_up_key = rig_.move_from > 0.0 ? "rig.move_from + rig.ramp" : "rig.ramp";
    WheelDescription wheel = ride_wheel(rig_, tires[0], duration);
    wheel.carried_mass = rig_.carrier_mass + rig_.rim_mass;
    d.wheels = {wheel};
    return d;
  }

  std::unique_ptr<Rig> make() const override { return make_held_drawbar_rig(rig_, hold_from_); }

  void fill_starts(std::span<const WheelSize> tires, double, std::optional<double> length,
                   std::span<const double> margins) override {
    if (!start_given_) rig_.start = length ? tires[0].radius + margins[0] : 0.0;
  }

  void complete(json& section) const override {
    write_filled(section,
                 {{"lowering_speed", rig_.lowering_speed},
                  {"rim_mass", rig_.rim_mass},
                  {"rim_spin_inertia", rig_.rim_spin_inertia},
                  {"rim_diametral_inertia", rig_.rim_diametral_inertia}},
                 {"carrier_mass", rig_.carrier_mass}, rig_.start);
  }

 private:
  DrawbarRigOptions rig_;
  double hold_from_;  // s
  bool start_given_;
  ReadContext context_;
};

}  // namespace

std::unique_ptr<RigSpec> read_cleat_stand(const json& section, const ReadContext& context) {
  CleatStandOptions stand;
  read_fields(section, stand);
  if (says(section, "load") && says(section, "carrier_mass"))
    throw input_error(context.file, context.key("load"),
                      fmt::format("is given beside '{}', expected one of the two", context.key("carrier_mass")));
  return std::make_unique<CleatStandSpec>(stand, says(section, "start"), context);
}

}  // namespace furrow::rigs
