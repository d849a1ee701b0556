// Reads structs with a list of keys (protocol/core/key.hpp) from files that nothing has checked before. Error messages
// are those of JsonReader.
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "protocol/core/fields.hpp"
#include "protocol/core/key.hpp"
#include "protocol/files/json_reader.hpp"
#include "protocol/files/key_schema.hpp"

namespace furrow {

template <HasFields T>
void read_keys(JsonReader& reader, T& target);

namespace detail {

template <class Value>
void take_value(JsonReader& reader, const Key& key, Value& value) {
  if constexpr (std::is_same_v<Value, bool>) {
    value = reader.flag(key.name);
  } else if constexpr (std::is_integral_v<Value>) {
    constexpr double kMost = std::numeric_limits<int>::max();
    value =
        reader.count(key.name, static_cast<int>(std::max(key.low, 0.0)), static_cast<int>(std::min(key.high, kMost)));
  } else if constexpr (std::is_floating_point_v<Value>) {
    value = reader.number(key.name);
    if (const std::string what = mistake(key, value); !what.empty()) reader.fail(key.name, what);
  } else if constexpr (HasFields<Value>) {
    JsonReader part = reader.child(key.name);
    read_keys(part, value);
    part.finish();
  } else if constexpr (std::is_enum_v<Value> || std::is_assignable_v<Value&, std::string>) {  // others: role::by_hand
    const std::string text = reader.text(key.name);
    if (const std::string what = mistake(key, text); !what.empty()) reader.fail(key.name, what);
    if constexpr (std::is_enum_v<Value>)
      value = static_cast<Value>(word_number(key, text));
    else
      value = text;
  }
}
template <std::size_t size>
void take_value(JsonReader& reader, const Key& key, std::array<double, size>& value) {
  const std::vector<double> numbers = reader.numbers(key.name, size);
  std::copy(numbers.begin(), numbers.end(), value.begin());
}
template <HasFields T>
void take_value(JsonReader& reader, const Key& key, std::vector<T>& value) {
  const nlohmann::json& list = reader.array(key.name);
  for (std::size_t i = 0; i < list.size(); ++i) {
    JsonReader entry(list[i], reader.file(), reader.full(fmt::format("{}[{}]", key.name, i)));
    read_keys(entry, value.emplace_back());
    entry.finish();
  }
}

}  // namespace detail

/// Reads every key that is given or required, except those with role::by_hand.
/// @throws Error(bad_input) naming file and key when one is missing, of another type or out of its range
template <HasFields T>
void read_keys(JsonReader& reader, T& target) {
  visit_fields(target, [&](auto& value, const Key& key) {
    if (key.is(role::by_hand)) return;
    reader.skip(key.name);
    if (key.missing == Missing::mistake || reader.given(key.name)) detail::take_value(reader, key, value);
  });
}

}  // namespace furrow
