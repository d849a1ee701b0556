// Where the program keeps what takes long to compute and can be computed again.
#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json_fwd.hpp>

namespace furrow {

/// ${XDG_CACHE_HOME:-~/.cache}/furrow/<kind>; empty when neither variable names a directory. It need not exist.
std::filesystem::path cache_folder(const std::string& kind);

/// Writes a file of such a folder, which is made. One that cannot be written costs time the next time, nothing else.
void keep_json(const std::filesystem::path& file, const nlohmann::ordered_json& json);

}  // namespace furrow
