#include "rigs/quarter_car_spec.hpp"

#include <string>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "protocol/core/assert.hpp"
#include "protocol/files/json_fields.hpp"
#include "rigs/ride_mount.hpp"
#include "rigs/rim_masses.hpp"
#include "vehicle/analysis/quarter_car.hpp"

namespace furrow::rigs {
namespace {

using nlohmann::json;

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
    WheelDescription wheel = ride_wheel(rig_, tires[0], duration);
    wheel.carried_mass = rig_.body_mass + rig_.unsprung_mass + rig_.rim_mass;
    d.wheels = {wheel};
    return d;
  }

  std::unique_ptr<Rig> make() const override { return make_quarter_car(rig_); }

  void fill_starts(std::span<const WheelSize> tires, double, std::optional<double> length,
                   std::span<const double> margins) override {
    if (!start_given_) rig_.start = length ? tires[0].radius + margins[0] : 0.0;
  }

  void complete(json& section) const override { write_car(section, rig_); }

 private:
  QuarterCarOptions rig_;
  bool start_given_;
  ReadContext context_;
};

}  // namespace

QuarterCarOptions mounted(QuarterCarOptions rig, const MountedTire& tire, const ReadContext& context) {
  FURROW_ASSERT(tire.radius > 0.0 && tire.mass >= 0.0, tire.radius, tire.mass);
  const RimMasses rim = mount_rim(rig, tire);
  if (is_open(rig.load)) take(rig.body_mass, tire.rim.carrier_mass);
  require_masses(rim, is_open(rig.load) && is_open(rig.body_mass), "body_mass", tire, context);
  take(rig.unsprung_mass, kUnsprungShare * rig.rim_mass);
  mount_body(rig, rig.unsprung_mass + rig.rim_mass + tire.mass, context);
  take(rig.suspension_stiffness, vehicle::usual_stiffness(rig.body_mass));
  take(rig.suspension_damping, vehicle::usual_damping(rig.body_mass, rig.suspension_stiffness));
  mount_lowering(rig, tire.radius);
  return rig;
}

std::unique_ptr<RigSpec> read_quarter_car(const json& section, const ReadContext& context) {
  QuarterCarOptions rig;
  read_fields(section, rig);
  refuse_load_beside_body(section, context);
  return std::make_unique<QuarterCarSpec>(rig, says(section, "start"), context);
}

}  // namespace furrow::rigs
