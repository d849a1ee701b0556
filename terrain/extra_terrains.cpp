#include "terrain/extra_terrains.hpp"

namespace furrow::terrain {

std::span<const TerrainEntry> extra_terrains() { return {}; }

}  // namespace furrow::terrain
