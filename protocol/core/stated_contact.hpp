// Contact that a tire computes by a law of its own, such as a handling tire on hard ground. The terrain gives the tire
// the forces that the tire states, and counts them like its own.
#pragma once

#include "protocol/core/fields.hpp"
#include "protocol/core/surface.hpp"

namespace furrow {

struct StatedContact {
  bool given =
      false;  // the tire states its contact: the terrain adds no force of its own, also where `forces` is empty
  NodalForces forces;           // on the tire, for the interval that begins; without tangents
  Vec3 normal = Vec3::UnitZ();  // of the ground where they act: the rest of a force is friction
};
void visit_fields(FieldsOf<StatedContact> auto& s, auto&& visit) {
  visit(s.given, Field{"given", ""});
  visit(s.forces, Field{"forces", ""});
  visit(s.normal, Field{"normal", ""});
}

}  // namespace furrow
