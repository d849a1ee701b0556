#include "protocol/files/cache_folder.hpp"

#include <cstdlib>

namespace furrow {

std::filesystem::path cache_folder(const std::string& kind) {
  if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache && *cache)
    return std::filesystem::path(cache) / "furrow" / kind;
  if (const char* home = std::getenv("HOME"); home && *home)
    return std::filesystem::path(home) / ".cache" / "furrow" / kind;
  return {};
}

}  // namespace furrow
