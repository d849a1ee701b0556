// Reads a tire file in any of its layouts.
#pragma once

#include <filesystem>

#include "tire/tire_file.hpp"

namespace furrow::tire {

/// @throws Error(bad_input) naming file and key.
TireFile read_tire_file(const std::filesystem::path& file);

}  // namespace furrow::tire
