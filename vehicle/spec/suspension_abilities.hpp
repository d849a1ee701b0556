// Abilities of a kind of suspension, derived from its members.
#pragma once

#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "vehicle/spec/suspension_spec.hpp"

namespace furrow::vehicle {

/// The kind can be steered.
inline constexpr auto kHasTieRods = []<class Spec>(const Spec&) {
  return requires(Spec s) { s.tie_rod; };
};
/// The kind has one housing for both sides, which carries shafts.
inline constexpr auto kHasHousing = []<class Spec>(const Spec&) {
  return requires(Spec s) { s.housing; };
};
/// The kind can carry the bearings of another axle.
inline constexpr auto kHasArms = []<class Spec>(const Spec&) {
  return requires(Spec s) { s.arm; };
};

template <class Ability>
bool can(const Ability& ability, const SuspensionSpec& suspension) {
  return std::visit(ability, suspension);
}

/// Names of the kinds with an ability, as files have them.
template <class Ability>
std::vector<std::string> kinds_that_can(const Ability& ability) {
  std::vector<std::string> names;
  [&]<std::size_t... i>(std::index_sequence<i...>) {
    const auto look = [&]<class Spec>(const Spec& spec) {
      if (ability(spec)) names.emplace_back(Spec::kType);
    };
    (look(std::variant_alternative_t<i, SuspensionSpec>()), ...);
  }
  (std::make_index_sequence<std::variant_size_v<SuspensionSpec>>{});
  return names;
}

}  // namespace furrow::vehicle
