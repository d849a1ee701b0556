// Makes JSON schemas of the files that people write from lists of keys (protocol/core/key.hpp), and describes in words
// what a schema expects of a value.
#pragma once

#include <concepts>
#include <optional>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include <nlohmann/json.hpp>

#include "protocol/core/fields.hpp"
#include "protocol/core/key.hpp"

namespace furrow {

/// The schema of a key.
/// @param type of its member in JSON, "" if the key's shape contains it
/// @param standard the member's default; discarded if there is none
nlohmann::ordered_json key_schema(const Key& key, const char* type, const nlohmann::ordered_json& standard);

/// The word of a key for a value of an enumeration, in the order of its values.
std::string word_of(const Key& key, int value);
int word_number(const Key& key, const std::string& word);

/// Adds a key to `properties` and `required` of the schema of an object.
/// @pre a key of this name that is already there is declared in the same way
void add_key(nlohmann::ordered_json& object, const Key& key, const nlohmann::ordered_json& node);

/// {"type": "object", …}, without keys yet.
nlohmann::ordered_json object_schema(const char* description);

/// A schema as readable text, with each key on its own line.
std::string schema_text(const nlohmann::ordered_json& schema);

/// Makes schemas of structs from their lists of keys; structs within them become definitions.
class SchemaWriter {
 public:
  nlohmann::ordered_json definitions = nlohmann::ordered_json::object();

  template <HasFields T>
  void add_keys(nlohmann::ordered_json& object) {
    const T defaults{};
    visit_fields(defaults, [&]<class F>(const auto& value, const F& field) {
      if constexpr (std::derived_from<F, Key>)
        if (field.is(role::key)) add_key(object, field, node_of(field, value));
    });
  }

  /// The schema of an object, with the key `type` if its struct has a kType.
  template <HasFields T>
  nlohmann::ordered_json object(const char* description) {
    nlohmann::ordered_json object = object_schema(description);
    if constexpr (requires { T::kType; })
      add_key(object, needed("type"), {{"const", T::kType}, {"description", "Kind of this part."}});
    add_keys<T>(object);
    return object;
  }

  /// {"$ref": …} to the definition of a struct with a kSchema.
  template <HasFields T>
  nlohmann::ordered_json reference() {
    if (!definitions.contains(T::kSchema.name)) definitions[T::kSchema.name] = object<T>(T::kSchema.description);
    return {{"$ref", std::string("#/definitions/") + T::kSchema.name}};
  }

 private:
  template <class Value>
  nlohmann::ordered_json node_of(const Key& key, const Value& value) {
    if constexpr (std::is_same_v<Value, bool>)
      return key_schema(key, "boolean", value);
    else if constexpr (std::is_integral_v<Value>)
      return key_schema(key, "integer", value);
    else if constexpr (std::is_floating_point_v<Value>)
      return key_schema(key, "number", value);
    else if constexpr (std::is_same_v<Value, nlohmann::json>)
      return key_schema(key, "", value);
    else if constexpr (std::is_enum_v<Value>)
      return key_schema(key, "string", word_of(key, static_cast<int>(value)));
    else if constexpr (std::is_constructible_v<std::string, Value>)
      return key_schema(key, "string", std::string(value));
    else
      return node_of_part(key, value);
  }
  template <HasFields T>
  nlohmann::ordered_json node_of_part(const Key&, const T&) {
    return reference<T>();
  }
  template <class T>
  nlohmann::ordered_json node_of_part(const Key& key, const std::optional<T>&) {
    Key without_default = key;
    without_default.missing = Missing::nothing;
    return node_of(without_default, T{});
  }
  template <HasFields T>
  nlohmann::ordered_json node_of_part(const Key& key, const std::vector<T>&) {
    nlohmann::ordered_json node = key_schema(key, "array", discarded());
    node["items"] = reference<T>();
    return node;
  }
  template <class... T>
  nlohmann::ordered_json node_of_part(const Key& key, const std::variant<T...>&) {
    nlohmann::ordered_json node = key_schema(key, "", discarded());
    node["oneOf"] = nlohmann::ordered_json::array({reference<T>()...});
    return node;
  }
  template <class T>
  nlohmann::ordered_json node_of_part(const Key& key, const T&) {
    return key_schema(key, "", discarded());
  }
  static nlohmann::ordered_json discarded() { return nlohmann::ordered_json::value_t::discarded; }
};

/// "a number, above 0 up to 1 m": the value that a schema expects.
std::string expectation(const nlohmann::json& node);
/// "0 to 10", "above 0"; empty without bounds.
std::string range_text(const nlohmann::json& node);
/// The text with the unit of the schema, if it has one.
std::string with_unit(const std::string& text, const nlohmann::json& node);
/// Whether the schema takes values of this type: "null", "integer".
bool allows_type(const nlohmann::json& node, const std::string& type);
/// "is 2 m, expected a number, above 0 up to 1 m"; empty if the value is as its schema requires. The contents of lists
/// and objects are not checked.
std::string mistake(const nlohmann::json& node, const nlohmann::json& value);

/// The same check of a number or a text against its key, except for the key's shape.
std::string mistake(const Key& key, const nlohmann::json& value);

/// Checks a number or a text against its key. @throws Error(bad_input) naming file, key and what is expected
void check_value(const Key& key, const nlohmann::json& value, const std::string& file, const std::string& section);

/// Checks numbers and texts of a struct against its list of keys. If a key may be null, a negative number stands for
/// null.
/// @throws Error(bad_input) as above
template <HasFields T>
void check_values(const T& values, const std::string& file, const std::string& section) {
  visit_fields(values, [&]<class F, class Value>(const Value& value, const F& field) {
    if constexpr (std::derived_from<F, Key>) {
      if constexpr (std::is_arithmetic_v<Value> && !std::is_same_v<Value, bool>)
        if (!field.takes_null || !(value < Value{})) check_value(field, value, file, section);
      if constexpr (std::is_same_v<Value, std::string>)
        if (*field.texts && !(field.takes_null && value.empty())) check_value(field, value, file, section);
    }
  });
}

}  // namespace furrow
