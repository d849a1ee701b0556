// Engines in addition to those in terrains.cpp. `furrow` has none; test programs link a source of their own instead of
// extra_terrains.cpp.
#pragma once

#include <span>

#include "terrain/terrain_entry.hpp"

namespace furrow::terrain {

std::span<const TerrainEntry> extra_terrains();

}  // namespace furrow::terrain
