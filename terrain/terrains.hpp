// The engines that a scenario may choose as `terrain.engine`. A new one is one line in terrains.cpp.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "protocol/core/fields.hpp"
#include "protocol/files/json_fields.hpp"
#include "protocol/files/read_context.hpp"
#include "terrain/terrain_entry.hpp"
#include "terrain/terrain_spec.hpp"

namespace furrow::terrain {

std::span<const TerrainEntry> terrains();

/// @throws Error(bad_input) listing the valid names.
const TerrainEntry& find_terrain(const std::string& engine, const ReadContext& context);

/// The engines that take this key of the section; empty for the keys that all share and for those that none has.
std::vector<std::string> engines_of_key(const std::string& key);

/// Keys of all engines that have this role, in order, each once.
std::vector<std::string> terrain_keys(unsigned roles);

/// Names of the engines whose terrain has grains, for messages: "'dem'".
std::string engines_with_grains();

/// Of a scenario that says nothing of its terrain.
std::shared_ptr<const TerrainSpec> default_terrain();

}  // namespace furrow::terrain
