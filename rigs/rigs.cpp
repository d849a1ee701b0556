#include "rigs/rigs.hpp"

#include <array>
#include <vector>

#include "protocol/core/error.hpp"
#include "protocol/files/json_fields.hpp"
#include "protocol/files/json_text.hpp"
#include "rigs/cleat_stand_spec.hpp"
#include "rigs/drawbar_spec.hpp"
#include "rigs/half_car_spec.hpp"
#include "rigs/quarter_car_spec.hpp"
#include "rigs/vehicle/vehicle_spec.hpp"

namespace furrow::rigs {
namespace {

constexpr auto kKinds = std::to_array<RigKind>({
    {"cleat_stand", "rolls one tire freely along x, lets it down on its load and then holds its axle at that height",
     key_list<CleatStandOptions>(), read_cleat_stand},
    {"drawbar", "pulls one tire along x at imposed speed and slip", key_list<DrawbarKeys>(), read_drawbar},
    {"half_car", "a quarter car whose body pitches on two wheels behind each other", key_list<HalfCarOptions>(),
     read_half_car},
    {"quarter_car", "carries a body over a freely rolling wheel on a spring and a damper, along x at imposed speed",
     key_list<QuarterCarOptions>(), read_quarter_car},
    {"vehicle", "a whole vehicle with a driver", key_list<VehicleRigOptions>(), read_vehicle_rig, tires_of_vehicle},
});

}  // namespace

std::span<const RigKind> rig_kinds() { return kKinds; }

std::vector<WheelTire> tires_of_rig(const nlohmann::json& section, const ReadContext& context) {
  if (!section.is_object() || !section.contains("type") || !section["type"].is_string()) return {};
  for (const RigKind& kind : kKinds)
    if (section["type"] == kind.name && kind.tires) return kind.tires(section, context);
  return {};
}

std::vector<std::string> kinds_of_key(const std::string& key) {
  std::vector<std::string> kinds;
  for (const RigKind& kind : kKinds)
    for (const Field& field : kind.keys.fields())
      if (field.is(role::key) && key == field.name) kinds.emplace_back(kind.name);
  return kinds;
}

std::unique_ptr<RigSpec> read_rig(const nlohmann::json& section, const ReadContext& context) {
  RigOptions options;
  read_fields(section, options);
  std::vector<std::string> valid;
  for (const RigKind& kind : kKinds) {
    if (options.type == kind.name) return kind.read(section, context);
    valid.emplace_back(kind.name);
  }
  throw input_error(context.file, context.key("type"), "is '" + options.type + "', expected " + one_of(valid));
}

}  // namespace furrow::rigs
