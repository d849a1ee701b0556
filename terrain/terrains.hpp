// The engines that a scenario may choose as `terrain.engine`. A new one is one line in terrains.cpp.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/files/json_fields.hpp"
#include "protocol/files/read_context.hpp"
#include "terrain/terrain_entry.hpp"
#include "terrain/terrain_spec.hpp"

namespace furrow::terrain {

std::span<const TerrainEntry> terrains();

/// @throws Error(bad_input) listing the valid names.
const TerrainEntry& find_terrain(const std::string& engine, const ReadContext& context);

/// The engines that take this key of the section; empty for a key that all share, and for one that no engine takes.
std::vector<std::string> engines_of_key(const std::string& key);

/// Whether the engine cannot honour this key of other engines, even with its default.
bool engine_denies(std::string_view engine, std::string_view key);

/// Keys of all engines that have this role, in order, each once.
std::vector<std::string> terrain_keys(unsigned roles);

/// Names of the engines whose terrain has grains, for messages: "'dem'".
std::string engines_with_grains();
std::string engines_with_stated_contacts();

/// The terrain of a scenario that has no key of the section.
std::shared_ptr<const TerrainSpec> default_terrain();

}  // namespace furrow::terrain
