// Where the program keeps what takes long to compute and can be computed again.
#pragma once

#include <filesystem>
#include <string>

namespace furrow {

/// ${XDG_CACHE_HOME:-~/.cache}/furrow/<kind>; empty when neither variable names a directory. It need not exist.
std::filesystem::path cache_folder(const std::string& kind);

}  // namespace furrow
