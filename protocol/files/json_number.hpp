// Numbers in JSON files of results.
#pragma once

#include <cmath>

#include <nlohmann/json.hpp>

namespace furrow {

/// The number, or null if it is not finite.
inline nlohmann::ordered_json json_number(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

}  // namespace furrow
