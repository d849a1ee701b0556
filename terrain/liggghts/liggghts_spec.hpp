// The engine liggghts of a scenario: grains in LIGGGHTS, on any number of ranks.
#pragma once

#include "terrain/liggghts/liggghts_options.hpp"
#include "terrain/terrain_entry.hpp"

namespace furrow::terrain::liggghts {

std::unique_ptr<TerrainSpec> read_liggghts_spec(const nlohmann::json& section, const ReadContext& context);

}  // namespace furrow::terrain::liggghts
