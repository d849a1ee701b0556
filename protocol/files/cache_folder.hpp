// Where the user's caches are: what can be made anew, and is kept because making it takes time.
#pragma once

#include <filesystem>

namespace furrow {

/// ${XDG_CACHE_HOME:-~/.cache}/furrow; empty when neither variable names a folder.
std::filesystem::path cache_folder();

}  // namespace furrow
