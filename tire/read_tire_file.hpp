// Reads the file of a shell tire in any of its layouts.
#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "tire/tire_file.hpp"

namespace furrow::tire {

/// @throws Error(bad_input) naming file and key.
TireFile read_tire_file(const std::filesystem::path& file);
/// Reads a tire from a document that was parsed from `file`.
TireFile read_tire_file(const nlohmann::json& document, const std::string& file);

}  // namespace furrow::tire
