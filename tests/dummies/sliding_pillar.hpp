// A small complete kind of suspension, made as CONTRIBUTING.md says: an upright that slides along a pillar of the
// chassis, on a spring and a shock absorber.
#pragma once

#include <optional>

#include "protocol/core/fields.hpp"
#include "protocol/files/json_reader.hpp"
#include "vehicle/parts/suspension_kinds.hpp"
#include "vehicle/spec/part_spec.hpp"

namespace furrow::vehicle {

struct SlidingPillarSpec {
  static constexpr const char* kType = "sliding_pillar";
  SpindleSpec spindle;
  BodySpec upright;
  Vec3 bottom = Vec3::Zero(), top = Vec3::Zero();  // of the pillar, m
  std::optional<SpringSpec> spring;
  std::optional<ShockSpec> shock;
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<SlidingPillarSpec> auto& s) {
  visit(Field{"spindle", "", role::key}, s.spindle);
  visit(Field{"upright", "", role::key}, s.upright);
  visit(Field{"bottom", "m", role::key}, s.bottom);
  visit(Field{"top", "m", role::key}, s.top);
  visit(Field{"spring", "", role::key}, s.spring);
  visit(Field{"shock", "", role::key}, s.shock);
}

/// @throws Error(bad_input) naming file, key and what was expected
void check_spec(const SlidingPillarSpec& s, const JsonReader& reader);

void add_suspension(AxleBuild& build, const Sides<SlidingPillarSpec>& sides);

}  // namespace furrow::vehicle
