// The folder for results that take long to compute and can be computed again.
#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json_fwd.hpp>

namespace furrow {

/// ${XDG_CACHE_HOME:-~/.cache}/furrow/<kind>; empty if neither variable contains a directory. It need not exist.
std::filesystem::path cache_folder(const std::string& kind);

/// Writes a file and creates its folder. If it cannot be written, only time is lost: the next run computes it again.
void keep_json(const std::filesystem::path& file, const nlohmann::ordered_json& json);

}  // namespace furrow
