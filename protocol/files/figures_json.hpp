// Writes results (structs with a list of fields, protocol/core/fields.hpp) as JSON objects: names with their units, and
// null for missing values.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "protocol/core/fields.hpp"
#include "protocol/core/vec.hpp"
#include "protocol/files/json_number.hpp"

namespace furrow {

/// "wheel_rate_N_per_m".
std::string name_with_unit(const Field& field);

template <HasFields T>
nlohmann::ordered_json figures_json(const T& values);

namespace detail {

inline nlohmann::ordered_json field_json(double value) { return json_number(value); }
inline nlohmann::ordered_json field_json(int value) { return value; }
inline nlohmann::ordered_json field_json(const std::string& value) { return value; }
inline nlohmann::ordered_json field_json(const Vec3& value) {
  return {json_number(value.x()), json_number(value.y()), json_number(value.z())};
}
template <HasFields T>
nlohmann::ordered_json field_json(const T& value) {
  return figures_json(value);
}
template <class T>
nlohmann::ordered_json field_json(const std::optional<T>& value) {
  return value ? field_json(*value) : nlohmann::ordered_json(nullptr);
}
template <class T>
nlohmann::ordered_json field_json(const std::vector<T>& values) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const T& value : values) list.push_back(field_json(value));
  return list;
}

}  // namespace detail

template <HasFields T>
nlohmann::ordered_json figures_json(const T& values) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  visit_fields(values,
               [&](const auto& value, const Field& field) { json[name_with_unit(field)] = detail::field_json(value); });
  return json;
}

}  // namespace furrow
