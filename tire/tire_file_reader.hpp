// What the files of all tire models have in common.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "protocol/core/surface.hpp"
#include "protocol/files/json_reader.hpp"

namespace furrow::tire {

/// Checks the version of a tire file's layout and takes the keys that every model's file may have: `model`, `rim`,
/// `name`, `source` and `$schema`. The model reads its own keys and then calls finish().
/// @throws Error(bad_input) naming file and key
void take_common_keys(JsonReader& reader);

/// A size of the tire in m, from 0.1 mm to 100 m: beyond, arithmetic on its mesh overflows or vanishes.
/// @throws Error(bad_input) naming file and key
double length_of(JsonReader& reader, const std::string& key);

/// The block `contact`: what grains and ground feel of the tread. @throws Error(bad_input) naming file and key
ContactMaterial read_contact(JsonReader reader);

/// 0 or 1, for one of two names; 1 where the key is not given.
int choice_of(JsonReader& reader, const std::string& key, std::string_view first, std::string_view second);
/// One of two names, in the order of their enumeration; the second where the key is not given.
/// @throws Error(bad_input) naming file and key
template <class Enum>
Enum choice_of(JsonReader& reader, const std::string& key, const std::array<std::string_view, 2>& names) {
  return static_cast<Enum>(choice_of(reader, key, names[0], names[1]));
}

}  // namespace furrow::tire
