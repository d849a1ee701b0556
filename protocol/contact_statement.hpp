// The message with which a tire that computes its contact by a law of its own says what the terrain shall give it.
#pragma once

#include "protocol/core/stated_contact.hpp"
#include "protocol/messages.hpp"

namespace furrow {

/// tire k → terrain, right after the SurfaceMotion of its prompt exchange and of the same kind, from tires that state
/// their contact.
struct ContactStatement {
  static constexpr MessageKind kKind = MessageKind::surface_motion;
  StepHeader header;
  StatedContact contact;
};
void visit_fields(FieldsOf<ContactStatement> auto& s, auto&& visit) {
  visit(s.header, Field{"header", ""});
  visit(s.contact, Field{"contact", ""});
}

}  // namespace furrow
