// Reads the structs of files of vehicles and drivers by their lists of fields: one key per field, required unless it is
// optional or may be missing, and checks each by check_spec(), which the caller of read_spec() declares for each
// struct. Complaints are JsonReader's: file, key, what was expected.
#pragma once

#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "protocol/files/json_reader.hpp"
#include "vehicle/spec/suspension_spec.hpp"

namespace furrow::vehicle {

template <HasFields T>
T read_spec(JsonReader reader);

namespace detail {

void take(JsonReader& reader, const std::string& key, double& value);
void take(JsonReader& reader, const std::string& key, bool& value);
void take(JsonReader& reader, const std::string& key, std::string& value);
void take(JsonReader& reader, const std::string& key, Vec3& value);
void take(JsonReader& reader, const std::string& key, Mat3& value);    // 3 or 6 numbers
void take(JsonReader& reader, const std::string& key, Points& value);  // at least two, x rises
void take(JsonReader& reader, const std::string& key, std::vector<double>& value);
void take(JsonReader& reader, const std::string& key, std::vector<std::string>& value);

/// The path of one entry of a list: "gears[2]".
std::string entry_path(const std::string& list, std::size_t index);

template <HasFields T>
void take(JsonReader& reader, const std::string& key, T& value) {
  value = read_spec<T>(reader.child(key));
}

template <HasFields T>
void take(JsonReader& reader, const std::string& key, std::vector<T>& value) {
  const nlohmann::json& list = reader.array(key);
  for (std::size_t i = 0; i < list.size(); ++i)
    value.push_back(read_spec<T>(JsonReader(list[i], reader.file(), entry_path(reader.full(key), i))));
}

}  // namespace detail

/// Takes the keys of T, except those with the role kReadApart; the reader may have others besides.
template <HasFields T>
void take_fields(JsonReader& reader, T& target) {
  visit_fields(
      [&](const Field& field, auto& value) {
        reader.skip(field.name);
        if (field.is(kReadApart)) return;
        if constexpr (requires { value.has_value(); }) {
          if (reader.given(field.name)) detail::take(reader, field.name, value.emplace());
        } else {
          if (!field.is(kMayMiss) || reader.given(field.name)) detail::take(reader, field.name, value);
        }
      },
      target);
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
