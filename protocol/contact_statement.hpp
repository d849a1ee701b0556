// The message in which a tire with a contact law of its own states the forces that the terrain has to give it.
#pragma once

#include "protocol/core/stated_contact.hpp"
#include "protocol/messages.hpp"

namespace furrow {

/// tire k → terrain, after the SurfaceMotion of the prompt exchange and of its kind, from tires with stated contact.
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
