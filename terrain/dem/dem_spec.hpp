// The terrain made of grains, engine dem, as a scenario describes it.
#pragma once

#include <memory>

#include <nlohmann/json_fwd.hpp>

#include "protocol/files/read_context.hpp"
#include "terrain/dem/dem_options.hpp"

namespace furrow::terrain::dem {

/// @pre the section was checked against the schema. @throws Error(bad_input) when the bed's file does not exist
std::unique_ptr<TerrainSpec> read_dem_spec(const nlohmann::json& section, const ReadContext& context);

/// The same for a program that has its options already.
std::unique_ptr<TerrainSpec> make_dem_spec(const DemOptions& options);

}  // namespace furrow::terrain::dem
