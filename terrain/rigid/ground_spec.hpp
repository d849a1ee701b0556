// Hard ground, engine rigid, as a scenario describes it.
#pragma once

#include <memory>

#include <nlohmann/json_fwd.hpp>

#include "protocol/files/read_context.hpp"
#include "terrain/rigid/ground_options.hpp"

namespace furrow::terrain {

/// @pre the section was checked against the schema
std::unique_ptr<TerrainSpec> read_ground_spec(const nlohmann::json& section, const ReadContext& context);

/// The same for a program that has its options already.
std::unique_ptr<TerrainSpec> make_ground_spec(const GroundOptions& options);

}  // namespace furrow::terrain
