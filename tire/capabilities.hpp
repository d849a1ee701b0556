// What some tire models can do beside the interfaces of tire.hpp and tire_spec.hpp, asked for by dynamic_cast.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "protocol/core/stated_contact.hpp"

namespace furrow::tire {

/// A Tire that computes its contact by a law of its own.
class StatesContact {
 public:
  virtual ~StatesContact() = default;
  /// What the terrain shall give it over its next interval, and no more; at the time of Tire::surface().
  virtual void stated_contact(StatedContact& out) const = 0;
};

/// Of a TireSpec that makes such tires.
class HasOwnContact {
 public:
  virtual ~HasOwnContact() = default;
  /// Why, for messages: "its forces are those of …"
  virtual std::string own_contact() const = 0;
};

/// A TireSpec whose file names other files.
class NamesFiles {
 public:
  virtual ~NamesFiles() = default;
  /// They count by what they hold.
  virtual std::vector<std::filesystem::path> files() const = 0;
};

/// Those of any spec. @param spec a TireSpec
template <class Spec>
std::vector<std::filesystem::path> files_of(const Spec& spec) {
  const auto* names = dynamic_cast<const NamesFiles*>(&spec);
  return names ? names->files() : std::vector<std::filesystem::path>{};
}

}  // namespace furrow::tire
