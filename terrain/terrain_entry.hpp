// One engine that a scenario may choose as `terrain.engine`.
#pragma once

#include <memory>
#include <string_view>

#include "protocol/files/json_fields.hpp"
#include "protocol/files/read_context.hpp"
#include "terrain/terrain_spec.hpp"

namespace furrow::terrain {

struct TerrainEntry {
  const char* name;  // terrain.engine
  const char* says;  // description of its terrain for that key: "hard ground"
  KeyList keys;      // of its options
  /// @pre the section was checked against the schema. @throws Error(bad_input) if a file does not exist
  std::unique_ptr<TerrainSpec> (*read)(const nlohmann::json& section, const ReadContext& context);
  /// True for keys of other engines that this engine cannot honour, even with their defaults; null: there are none.
  bool (*denies)(std::string_view key) = nullptr;
};

}  // namespace furrow::terrain
