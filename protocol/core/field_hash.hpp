// Digests of structs with a list of fields. Only values that differ from the default count, with their names. So a key
// that is added later does not change digests of files that do not use it.
#pragma once

#include <string>
#include <type_traits>

#include "protocol/core/assert.hpp"
#include "protocol/core/fields.hpp"
#include "protocol/core/hash.hpp"

namespace furrow {

/// Adds name and value of every field that has all `roles` and differs from its default.
/// @pre some role is asked for; these fields are numbers, enumerations, switches or strings
template <HasFields T>
void add_fields(Hash& hash, const T& values, unsigned roles) {
  FURROW_ASSERT(roles != role::none, roles);
  const T defaults{};
  std::size_t here = 0;  // index of the field in the list, by which its default is found
  const auto add = [&](const auto& value, const Field& field) {
    const std::size_t place = here++;
    if (!field.is(roles)) return;
    using Value = std::remove_cvref_t<decltype(value)>;
    bool same = false;
    std::size_t other = 0;
    visit_fields(defaults, [&](const auto& standard, const Field&) {
      if constexpr (std::is_same_v<std::remove_cvref_t<decltype(standard)>, Value>)
        if (other == place) same = standard == value;
      ++other;
    });
    if (same) return;
    hash.add(std::string(field.name));
    if constexpr (std::is_convertible_v<Value, std::string>)
      hash.add(std::string(value));
    else if constexpr (std::is_arithmetic_v<Value> || std::is_enum_v<Value>)
      hash.add(&value, sizeof value);
  };
  visit_fields(values, add);
}

}  // namespace furrow
