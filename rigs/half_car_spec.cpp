#include "rigs/half_car_spec.hpp"

#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "protocol/files/json_fields.hpp"
#include "rigs/ride_spec.hpp"

namespace furrow::rigs {
namespace {

class HalfCarSpec final : public RideSpec<HalfCarOptions> {
 public:
  HalfCarSpec(const HalfCarOptions& rig, const nlohmann::json& section, ReadContext context)
      : RideSpec("half_car", {0.0, -rig.wheelbase}, rig, section, std::move(context)) {}

  std::unique_ptr<Rig> make() const override { return make_half_car(rig_); }
  void complete(nlohmann::json& section) const override {
    write(section, {"body_mass", rig_.body_mass},
          {{"pitch_inertia", rig_.pitch_inertia},
           {"unsprung_mass", rig_.unsprung_mass},
           {"suspension_stiffness", rig_.suspension_stiffness},
           {"suspension_damping", rig_.suspension_damping},
           {"rear_suspension_stiffness", rig_.rear_suspension_stiffness},
           {"rear_suspension_damping", rig_.rear_suspension_damping},
           {"touchdown_time", rig_.touchdown_time}});
  }

 private:
  void mount_tires(std::span<const MountedTire> tires) override { rig_ = mounted(rig_, tires.first<2>(), context_); }
  std::string text() const override {
    return fmt::format("1 half car, body {:.5g} kg and {:.5g} kg m², wheelbase {:.4g} m", rig_.body_mass,
                       rig_.pitch_inertia, rig_.wheelbase);
  }
  double carried_mass(std::size_t k) const override {
    const double share = k == 0 ? rig_.front_share : 1.0 - rig_.front_share;
    return share * rig_.body_mass + unsprung_mass(k);
  }
  double unsprung_mass(std::size_t) const override { return rig_.unsprung_mass + rig_.rim_mass; }
};

}  // namespace

HalfCarOptions mounted(HalfCarOptions rig, std::span<const MountedTire, 2> tires, const ReadContext& context) {
  mount_car(rig, std::span<const MountedTire>(tires), context);
  const double share = rig.front_share, rest = 1.0 - share;
  take(rig.pitch_inertia, rig.body_mass * rig.wheelbase * rig.wheelbase * share * rest);
  take(rig.suspension_stiffness, usual_stiffness(share * rig.body_mass));
  take(rig.suspension_damping, usual_damping(share * rig.body_mass, rig.suspension_stiffness));
  take(rig.rear_suspension_stiffness, rig.suspension_stiffness * rest / share);
  take(rig.rear_suspension_damping, rig.suspension_damping * rest / share);
  return rig;
}

std::unique_ptr<RigSpec> read_half_car(const nlohmann::json& section, const ReadContext& context) {
  HalfCarOptions rig;
  read_fields(section, rig);
  refuse_both(section, "load", "body_mass", context);
  return std::make_unique<HalfCarSpec>(rig, section, context);
}

}  // namespace furrow::rigs
