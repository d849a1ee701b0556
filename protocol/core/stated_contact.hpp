// Contact that a tire computes by a law of its own, such as a handling tire on hard ground. The terrain gives the tire
// the forces that the tire states, and counts them like its own.
#pragma once

#include <vector>

#include "protocol/core/fields.hpp"
#include "protocol/core/surface.hpp"

namespace furrow {

struct StatedContact {
  bool given =
      false;  // the tire states its contact: the terrain adds no force of its own, also where `forces` is empty
  NodalForces forces;          // on the tire, for the interval that begins; without tangents
  std::vector<Vec3> friction;  // the part of each force that is friction, N; the rest acts along the ground's normal
  double energy = 0.0;         // elastic energy of the contact at the interval's end, J
};
void visit_fields(FieldsOf<StatedContact> auto& s, auto&& visit) {
  visit(s.given, Field{"given", ""});
  visit(s.forces, Field{"forces", ""});
  visit(s.friction, Field{"friction", "N"});
  visit(s.energy, Field{"energy", "J"});
}

}  // namespace furrow
