#include "rigs/quarter_car_spec.hpp"

#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "protocol/files/json_fields.hpp"
#include "rigs/ride_spec.hpp"

namespace furrow::rigs {
namespace {

class QuarterCarSpec final : public RideSpec<QuarterCarOptions> {
 public:
  QuarterCarSpec(const QuarterCarOptions& rig, const nlohmann::json& section, ReadContext context)
      : RideSpec("quarter_car", {0.0}, rig, section, std::move(context)) {}

  std::unique_ptr<Rig> make() const override { return make_quarter_car(rig_); }
  void complete(nlohmann::json& section) const override {
    write(section, {"body_mass", rig_.body_mass},
          {{"unsprung_mass", rig_.unsprung_mass},
           {"suspension_stiffness", rig_.suspension_stiffness},
           {"suspension_damping", rig_.suspension_damping},
           {"touchdown_time", rig_.touchdown_time}});
  }

 private:
  void mount_tires(std::span<const MountedTire> tires) override { rig_ = mounted(rig_, tires[0], context_); }
  std::string text() const override {
    return fmt::format("1 quarter car, body {:.5g} kg on {:.4g} N/m and {:.4g} N s/m", rig_.body_mass,
                       rig_.suspension_stiffness, rig_.suspension_damping);
  }
  double carried_mass(std::size_t k) const override { return rig_.body_mass + unsprung_mass(k); }
  double unsprung_mass(std::size_t) const override { return rig_.unsprung_mass + rig_.rim_mass; }
};

}  // namespace

QuarterCarOptions mounted(QuarterCarOptions rig, const MountedTire& tire, const ReadContext& context) {
  mount_car(rig, {&tire, 1}, context);
  take(rig.suspension_stiffness, usual_stiffness(rig.body_mass));
  take(rig.suspension_damping, usual_damping(rig.body_mass, rig.suspension_stiffness));
  return rig;
}

std::unique_ptr<RigSpec> read_quarter_car(const nlohmann::json& section, const ReadContext& context) {
  QuarterCarOptions rig;
  read_fields(section, rig);
  refuse_both(section, "load", "body_mass", context);
  return std::make_unique<QuarterCarSpec>(rig, section, context);
}

}  // namespace furrow::rigs
