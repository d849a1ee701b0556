// Writes structs with a list of fields (protocol/core/fields.hpp) as JSON: one key per field.
#pragma once

#include <nlohmann/json.hpp>

#include "protocol/core/fields.hpp"

namespace furrow {

/// Every field that has all `roles`, by name. As in scenarios, null stands for an empty text, and for a number below
/// zero whose default is below zero.
template <HasFields T>
nlohmann::ordered_json fields_json(const T& values, unsigned roles) {
  nlohmann::ordered_json object = nlohmann::ordered_json::object(), standard = object;
  const auto write_to = [&](nlohmann::ordered_json& target) {
    return [&](const auto& value, const Field& field) {
      if (field.is(roles)) target[field.name] = value;
    };
  };
  visit_fields(values, write_to(object));
  const T defaults{};
  visit_fields(defaults, write_to(standard));
  for (auto& [name, value] : object.items()) {
    const bool unset = value.is_number() && value < 0 && standard[name] < 0;
    if (unset || value == "") value = nullptr;
  }
  return object;
}

}  // namespace furrow
