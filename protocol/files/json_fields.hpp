// Reads structs with a list of fields (protocol/core/fields.hpp) from JSON objects: one key per field.
#pragma once

#include <string>
#include <type_traits>
#include <vector>

#include <nlohmann/json.hpp>

#include "protocol/core/assert.hpp"
#include "protocol/core/fields.hpp"
#include "protocol/files/key_schema.hpp"

namespace furrow {

/// Reads every field with role::key whose key is present and not null; the others keep their values.
/// @pre the object was checked against the schema: a value of another type throws nlohmann::json::exception
template <HasFields T>
void read_fields(const nlohmann::json& object, T& target) {
  FURROW_ASSERT(object.is_object(), object.type_name());
  visit_fields(target, [&](auto& value, const Field& field) {
    using Value = std::remove_reference_t<decltype(value)>;
    if constexpr (requires { object.begin()->template get<Value>(); }) {
      if (!field.is(role::key)) return;
      const auto entry = object.find(field.name);
      if (entry != object.end() && !entry->is_null()) value = entry->template get<Value>();
    }
  });
}

/// Names of the fields that have all `roles`, in order.
template <HasFields T>
std::vector<std::string> field_names(unsigned roles) {
  std::vector<std::string> names;
  const T defaults{};
  visit_fields(defaults, [&](const auto&, const Field& field) {
    if (field.is(roles)) names.emplace_back(field.name);
  });
  return names;
}

/// The fields of T and nothing else of it, for a table of models that stores the keys of a section.
template <HasFields T>
std::vector<Field> fields_of() {
  std::vector<Field> fields;
  const T defaults{};
  visit_fields(defaults, [&](const auto&, const Field& field) { fields.push_back(field); });
  return fields;
}

/// The keys of a model. Its entry in a table of models has one, made by key_list<Options>().
struct KeyList {
  std::vector<Field> (*fields)() = nullptr;  // the keys are those with role::key
  void (*add_to)(SchemaWriter& writer, nlohmann::ordered_json& section) = nullptr;
};
template <HasFields T>
constexpr KeyList key_list() {
  return {fields_of<T>, [](SchemaWriter& writer, nlohmann::ordered_json& section) { writer.add_keys<T>(section); }};
}

}  // namespace furrow
