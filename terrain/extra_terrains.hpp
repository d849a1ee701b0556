// Engines beside those of the table in terrains.cpp. `furrow` has none; programs of the tests link a source of their
// own in place of extra_terrains.cpp.
#pragma once

#include <span>

#include "terrain/terrain_entry.hpp"

namespace furrow::terrain {

std::span<const TerrainEntry> extra_terrains();

}  // namespace furrow::terrain
