// What terrains can do whose ground a tire may know by itself (protocol/core/stated_contact.hpp): a capability beside
// the interfaces of terrain.hpp and terrain_spec.hpp, asked for by dynamic_cast. Other terrains refuse such tires.
#pragma once

#include <span>
#include <string>

#include "protocol/core/stated_contact.hpp"

namespace furrow::terrain {

class TakesStatedContacts {
 public:
  virtual ~TakesStatedContacts() = default;
  /// For the next advance, one for each attached surface: surfaces whose contact is given get its forces and no others.
  /// @pre every vertex is one of its surface's
  virtual void state_contacts(std::span<const StatedContact> contacts) = 0;
};

/// Of a TerrainSpec that makes such terrains.
class AllowsStatedContacts {
 public:
  virtual ~AllowsStatedContacts() = default;
  /// Why this ground is none that a tire may know by itself: a key of the section `terrain` and what is expected of it;
  /// empty: it is one.
  struct Refusal {
    std::string key, text;
  };
  virtual Refusal refuses_stated_contacts() const = 0;
};

}  // namespace furrow::terrain
