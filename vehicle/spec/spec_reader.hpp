// Reads the structs of vehicle and driver files by their lists of keys. Each value is checked by its key, and then each
// struct by check_spec(), which the caller of read_spec() declares for it. JsonReader reports errors with file, key and
// the expected value.
#pragma once

#include <concepts>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "protocol/core/fields.hpp"
#include "protocol/core/key.hpp"
#include "protocol/files/json_reader.hpp"
#include "vehicle/spec/suspension_spec.hpp"

namespace furrow::vehicle {

template <HasFields T>
T read_spec(JsonReader reader);

namespace detail {

// Each @throws Error(bad_input) naming file and key
void take(JsonReader& reader, const Key& key, double& value);
void take(JsonReader& reader, const Key& key, bool& value);
void take(JsonReader& reader, const Key& key, std::string& value);
void take(JsonReader& reader, const Key& key, Vec3& value);
void take(JsonReader& reader, const Key& key, Mat3& value);    // 3 or 6 numbers
void take(JsonReader& reader, const Key& key, Points& value);  // at least two, x rises
void take(JsonReader& reader, const Key& key, std::vector<double>& value);
void take(JsonReader& reader, const Key& key, std::vector<std::string>& value);

/// The path of one entry of a list: "gears[2]".
std::string entry_path(const std::string& list, std::size_t index);

/// Refuses the text under `type`, which is not one of `types`.
[[noreturn]] void refuse_type(JsonReader& reader, const std::vector<std::string>& types);

template <HasFields T>
void take(JsonReader& reader, const Key& key, T& value) {
  value = read_spec<T>(reader.child(key.name));
}

template <HasFields T>
void take(JsonReader& reader, const Key& key, std::vector<T>& value) {
  const nlohmann::json& list = reader.array(key.name);
  for (std::size_t i = 0; i < list.size(); ++i)
    value.push_back(read_spec<T>(JsonReader(list[i], reader.file(), entry_path(reader.full(key.name), i))));
}

/// The alternative whose kType is the text under `type`.
template <HasFields... T>
void take(JsonReader& reader, const Key& key, std::variant<T...>& value) {
  JsonReader part = reader.child(key.name);
  const std::string type = part.text("type");
  const auto take_if = [&]<class Option>(std::type_identity<Option>) {
    if (type == Option::kType) value = read_spec<Option>(part);
    return type == Option::kType;
  };
  if (!(take_if(std::type_identity<T>()) || ...)) refuse_type(part, {T::kType...});
}

template <class T>
void take(JsonReader& reader, const Key& key, std::optional<T>& value) {
  take(reader, key, value.emplace());
}

}  // namespace detail

/// Takes the keys of T, except those with the role role::by_hand; the reader may have further keys.
template <HasFields T>
void take_fields(JsonReader& reader, T& target) {
  visit_fields(target, [&](auto& value, const Key& key) {
    reader.skip(key.name);
    if (key.is(role::by_hand)) return;
    if (key.missing == Missing::mistake || reader.given(key.name)) detail::take(reader, key, value);
  });
}

/// @throws Error(bad_input) naming file and key
template <HasFields T>
T read_spec(JsonReader reader) {
  T target{};
  take_fields(reader, target);
  reader.finish();
  check_spec(target, reader);
  return target;
}

}  // namespace furrow::vehicle
