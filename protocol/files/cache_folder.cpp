#include "protocol/files/cache_folder.hpp"

#include <cstdlib>

#include <nlohmann/json.hpp>

#include "protocol/core/error.hpp"
#include "protocol/files/text_file.hpp"

namespace furrow {

std::filesystem::path cache_folder(const std::string& kind) {
  // Relative paths in this variable are to be ignored [XDG Base Directory Specification 0.8].
  if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache && std::filesystem::path(cache).is_absolute())
    return std::filesystem::path(cache) / "furrow" / kind;
  if (const char* home = std::getenv("HOME"); home && *home)
    return std::filesystem::path(home) / ".cache" / "furrow" / kind;
  return {};
}

void keep_json(const std::filesystem::path& file, const nlohmann::ordered_json& json) {
  std::error_code failed;
  std::filesystem::create_directories(file.parent_path(), failed);
  try {
    write_whole_file(file, json.dump(2) + "\n");
  } catch (const Error&) {
    return;
  }
}

}  // namespace furrow
