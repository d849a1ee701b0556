// Keys of the section `rig` in a scenario.
#pragma once

#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "protocol/core/error.hpp"
#include "protocol/files/read_context.hpp"

namespace furrow::rigs {

inline bool says(const nlohmann::json& object, const char* name) {
  const auto entry = object.find(name);
  return entry != object.end() && !entry->is_null();
}

/// Refuses two keys that exclude each other. @param before prefix of their names: "", "wheels.1."
/// @throws Error(bad_input) if an object gives both
inline void refuse_both(const nlohmann::json& object, const char* one, const char* other, const ReadContext& context,
                        const std::string& before = "") {
  if (says(object, one) && says(object, other))
    throw input_error(context.file, context.key(before + one),
                      fmt::format("is given beside '{}', expected one of the two", context.key(before + other)));
}

}  // namespace furrow::rigs
