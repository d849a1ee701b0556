// Reads structs with a list of fields (protocol/core/fields.hpp) from files that nothing has checked before: one key
// per field, every one of them required. Complaints are JsonReader's.
#pragma once

#include <limits>
#include <string>
#include <type_traits>

#include "protocol/core/fields.hpp"
#include "protocol/files/json_reader.hpp"

namespace furrow {

/// Takes every field with role::key: numbers, whole numbers of 0 or more, switches, texts.
/// Ranges are for the caller to check.
/// @throws Error(bad_input) naming file and key when one is missing or of another type
template <HasFields T>
void read_required(JsonReader& reader, T& target) {
  visit_fields(
      [&](const Field& field, auto& value) {
        using Value = std::remove_cvref_t<decltype(value)>;
        if (!field.is(role::key)) return;
        if constexpr (std::is_same_v<Value, bool>)
          value = reader.flag(field.name);
        else if constexpr (std::is_same_v<Value, int>)
          value = reader.count(field.name, 0, std::numeric_limits<int>::max());
        else if constexpr (std::is_same_v<Value, double>)
          value = reader.number(field.name);
        else
          value = reader.text(field.name);
      },
      target);
}

}  // namespace furrow
