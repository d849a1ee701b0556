// The meridian of a tire file, which both layouts write alike.
#pragma once

#include <string>
#include <vector>

#include "protocol/files/json_reader.hpp"
#include "tire/tire_file.hpp"

namespace furrow::tire {

/// Rows t, x, y (both layouts share them).
std::vector<ProfileKnot> read_profile(JsonReader& reader, const std::string& key);

}  // namespace furrow::tire
