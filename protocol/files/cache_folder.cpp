#include "protocol/files/cache_folder.hpp"

#include <cstdlib>

namespace furrow {

std::filesystem::path cache_folder() {
  if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache && *cache)
    return std::filesystem::path(cache) / "furrow";
  if (const char* home = std::getenv("HOME"); home && *home)
    return std::filesystem::path(home) / ".cache" / "furrow";
  return {};
}

}  // namespace furrow
