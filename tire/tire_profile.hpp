// The meridian of a tire file. It has the same form in both layouts.
#pragma once

#include <string>
#include <vector>

#include "protocol/files/json_reader.hpp"
#include "tire/tire_file.hpp"

namespace furrow::tire {

/// Reads rows of t, x, y.
std::vector<ProfileKnot> read_profile(JsonReader& reader, const std::string& key);

}  // namespace furrow::tire
