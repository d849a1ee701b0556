// A small complete kind of suspension, made by the recipe in CONTRIBUTING.md: an upright that slides along a pillar of
// the chassis, on a spring and a shock absorber.
#pragma once

#include <optional>

#include "protocol/core/fields.hpp"
#include "protocol/core/key.hpp"
#include "protocol/core/vec.hpp"
#include "protocol/files/json_reader.hpp"
#include "vehicle/parts/suspension_kinds.hpp"
#include "vehicle/spec/part_keys.hpp"
#include "vehicle/spec/part_spec.hpp"

namespace furrow::vehicle {

struct SlidingPillarSpec {
  static constexpr SchemaName kSchema{"sliding_pillar", "An upright on each side that slides along a pillar."};
  static constexpr const char* kType = "sliding_pillar";
  SpindleSpec spindle;
  BodySpec upright;
  Vec3 bottom = Vec3::Zero(), top = Vec3::Zero();  // of the pillar, m
  std::optional<SpringSpec> spring;
  std::optional<ShockSpec> shock;
};
void visit_fields(FieldsOf<SlidingPillarSpec> auto& s, auto&& visit) {
  visit(s.spindle, needed("spindle"));
  visit(s.upright, needed("upright"));
  visit(s.bottom, needed("bottom", "m", keys::kPoint, "Lower end of the pillar, from the axle's origin."));
  visit(s.top, needed("top", "m", keys::kPoint, "Upper end of the pillar, from the axle's origin."));
  visit(s.spring, key("spring"));
  visit(s.shock, key("shock"));
}

/// @throws Error(bad_input) naming file, key and what was expected
void check_spec(const SlidingPillarSpec& s, const JsonReader& reader);

void add_suspension(AxleBuild& build, const Sides<SlidingPillarSpec>& sides);

}  // namespace furrow::vehicle
