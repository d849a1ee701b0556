#include "rigs/cleat_stand_spec.hpp"

#include <string>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "protocol/core/error.hpp"
#include "protocol/files/json_fields.hpp"
#include "rigs/drawbar_mount.hpp"
#include "rigs/ride_spec.hpp"

namespace furrow::rigs {
namespace {

using nlohmann::json;

DrawbarRigOptions drawbar_of(const CleatStandOptions& stand) {
  DrawbarRigOptions rig;
  static_cast<RailOptions&>(rig) = stand;
  rig.mode = "free_rolling";
  rig.slip = 0.0;
  rig.touchdown_time = stand.hold_axle_from;
  rig.carrier_mass = stand.carrier_mass;
  return rig;
}

class CleatStandSpec final : public RideSpec<DrawbarRigOptions> {
 public:
  CleatStandSpec(const CleatStandOptions& stand, const json& section, ReadContext context)
      : RideSpec("cleat_stand", {0.0}, drawbar_of(stand), section, std::move(context)),
        hold_from_(stand.hold_axle_from) {}

  RigDescription describe(std::span<const WheelSize> tires, double duration) const override {
    if (hold_from_ >= duration)
      throw input_error(context_.file, context_.key("hold_axle_from"),
                        fmt::format("is {:g} s, expected a time before the run ends at {:g} s", hold_from_, duration));
    return RideSpec::describe(tires, duration);
  }
  std::unique_ptr<Rig> make() const override { return make_held_drawbar_rig(rig_, hold_from_); }
  void complete(json& section) const override { write(section, {"carrier_mass", rig_.carrier_mass}, {}); }

 private:
  void mount_tires(std::span<const MountedTire> tires) override { rig_ = mounted(rig_, tires[0], context_, ""); }
  std::string text() const override {
    return fmt::format("1 cleat test stand, axle held from {:.4g} s on", hold_from_);
  }
  double carried_mass(std::size_t) const override { return rig_.carrier_mass + rig_.rim_mass; }
  double unsprung_mass(std::size_t k) const override { return carried_mass(k); }

  double hold_from_;  // s
};

}  // namespace

std::unique_ptr<RigSpec> read_cleat_stand(const json& section, const ReadContext& context) {
  CleatStandOptions stand;
  read_fields(section, stand);
  refuse_both(section, "load", "carrier_mass", context);
  return std::make_unique<CleatStandSpec>(stand, section, context);
}

}  // namespace furrow::rigs
