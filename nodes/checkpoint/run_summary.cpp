#include "nodes/checkpoint/run_summary.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "protocol/files/json_text.hpp"

namespace furrow::checkpoint {

using Json = nlohmann::ordered_json;

Json read_summary(const std::filesystem::path& run, std::size_t wheel) {
  Json summary =
      read_json_if_whole(run / (wheel == 0 ? "summary.json" : fmt::format("summary_wheel{}.json", wheel)));
  return summary.is_object() ? summary : Json();
}

Json value_at(const Json& summary, const std::string& path) {
  const Json* at = &summary;
  for (std::size_t from = 0; from <= path.size();) {
    const std::size_t to = std::min(path.find('.', from), path.size());
    const std::string part = path.substr(from, to - from);
    if (at->is_array() && !part.empty() && part.find_first_not_of("0123456789") == std::string::npos &&
        std::stoul(part) < at->size())
      at = &(*at)[std::stoul(part)];
    else if (at->is_object() && at->contains(part))
      at = &(*at)[part];
    else
      return {};
    from = to + 1;
  }
  return *at;
}

}  // namespace furrow::checkpoint
