#include "rigs/half_car_spec.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/json_fields.hpp"
#include "protocol/files/json_text.hpp"
#include "rigs/lowering.hpp"
#include "rigs/ride_mount.hpp"
#include "rigs/rim_masses.hpp"
#include "vehicle/analysis/quarter_car.hpp"

namespace furrow::rigs {
namespace {

using nlohmann::json;

class HalfCarSpec final : public RigSpec {
 public:
  HalfCarSpec(const HalfCarOptions& rig, bool start_given, ReadContext context)
      : rig_(rig), start_given_(start_given), context_(std::move(context)) {}

  std::size_t wheel_count() const override { return 2; }
  void mount(std::span<const MountedTire> tires) override {
    FURROW_ASSERT(tires.size() == 2, tires.size());
    rig_ = mounted(rig_, tires.first<2>(), context_);
  }

  RigDescription describe(std::span<const WheelSize> tires, double duration) const override {
    FURROW_ASSERT(tires.size() == 2, tires.size());
    RigDescription d;
    d.kind = "half_car";
    d.text = fmt::format("1 half car, body {:.5g} kg and {:.5g} kg m², wheelbase {:.4g} m", rig_.body_mass,
                         rig_.pitch_inertia, rig_.wheelbase);
    d.speeds_up_until = rig_.move_from + rig_.ramp;
    d.speeds_up_key = rig_.move_from > 0.0 ? "rig.move_from + rig.ramp" : "rig.ramp";
    for (const int k : {0, 1}) {
      const double share = k == 0 ? rig_.front_share : 1.0 - rig_.front_share;
      WheelDescription wheel = ride_wheel(rig_, tires[k], duration);
      wheel.name = k == 0 ? "front" : "rear";
      wheel.start_offset = k == 0 ? 0.0 : -rig_.wheelbase;
      wheel.from += wheel.start_offset, wheel.to += wheel.start_offset;
      wheel.carried_mass = share * rig_.body_mass + rig_.unsprung_mass + rig_.rim_mass;
      d.wheels.push_back(wheel);
    }
    return d;
  }

  std::unique_ptr<Rig> make() const override { return make_half_car(rig_); }

  void fill_starts(std::span<const WheelSize> tires, double, std::optional<double> length,
                   std::span<const double> margins) override {
    if (start_given_) return;
    rig_.start = !length ? 0.0 : std::max(tires[1].radius + margins[1] + rig_.wheelbase, tires[0].radius + margins[0]);
  }

  void complete(json& section) const override {
    write_car(section, rig_,
              {{"pitch_inertia", rig_.pitch_inertia},
               {"rear_suspension_stiffness", rig_.rear_suspension_stiffness},
               {"rear_suspension_damping", rig_.rear_suspension_damping}});
  }

 private:
  HalfCarOptions rig_;
  bool start_given_;
  ReadContext context_;
};

}  // namespace

HalfCarOptions mounted(HalfCarOptions rig, std::span<const MountedTire, 2> tires, const ReadContext& context) {
  const MountedTire &front = tires[0], &rear = tires[1];
  FURROW_ASSERT(front.radius > 0.0 && rear.radius > 0.0, front.radius, rear.radius);
  const RimMasses rim = mount_rim(rig, front);
  if (is_open(rig.load) && !is_open(front.rim.carrier_mass) && !is_open(rear.rim.carrier_mass))
    take(rig.body_mass, front.rim.carrier_mass + rear.rim.carrier_mass);
  require_masses(rim, is_open(rig.load) && is_open(rig.body_mass), "body_mass", front, context);
  take(rig.unsprung_mass, kUnsprungShare * rig.rim_mass);
  mount_body(rig, 2.0 * (rig.unsprung_mass + rig.rim_mass) + front.mass + rear.mass, context);
  const double share = rig.front_share, rest = 1.0 - share;
  take(rig.pitch_inertia, rig.body_mass * rig.wheelbase * rig.wheelbase * share * rest);
  take(rig.suspension_stiffness, vehicle::usual_stiffness(share * rig.body_mass));
  take(rig.suspension_damping, vehicle::usual_damping(share * rig.body_mass, rig.suspension_stiffness));
  take(rig.rear_suspension_stiffness, rig.suspension_stiffness * rest / share);
  take(rig.rear_suspension_damping, rig.suspension_damping * rest / share);
  mount_lowering(rig, std::max(front.radius, rear.radius));
  return rig;
}

std::unique_ptr<RigSpec> read_half_car(const json& section, const ReadContext& context) {
  HalfCarOptions rig;
  read_fields(section, rig);
  refuse_load_beside_body(section, context);
  return std::make_unique<HalfCarSpec>(rig, says(section, "start"), context);
}

}  // namespace furrow::rigs
