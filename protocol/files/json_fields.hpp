// Reads structs with a list of fields (protocol/core/fields.hpp) from JSON objects: one key per field.
#pragma once

#include <string>
#include <type_traits>
#include <vector>

#include <nlohmann/json.hpp>

#include "protocol/core/assert.hpp"
#include "protocol/core/fields.hpp"

namespace furrow {

/// Takes every field that has all `roles` and whose key is there and not null; the others keep their values.
/// @pre the object was checked against the schema: a value of another type throws nlohmann::json::exception
template <HasFields T>
void read_fields(const nlohmann::json& object, T& target, unsigned roles = role::key) {
  FURROW_ASSERT(object.is_object(), object.type_name());
  visit_fields(
      [&](const Field& field, auto& value) {
        using Value = std::remove_reference_t<decltype(value)>;
        if constexpr (requires { object.begin()->template get<Value>(); }) {
          if (!field.is(roles)) return;
          const auto entry = object.find(field.name);
          if (entry != object.end() && !entry->is_null()) value = entry->template get<Value>();
        }
      },
      target);
}

/// Names of the fields that have all `roles`, in order.
template <HasFields T>
std::vector<std::string> field_names(unsigned roles) {
  std::vector<std::string> names;
  const T defaults{};
  visit_fields(
      [&](const Field& field, const auto&) {
        if (field.is(roles)) names.emplace_back(field.name);
      },
      defaults);
  return names;
}

}  // namespace furrow
