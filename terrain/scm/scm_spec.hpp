// Empirical soil, engine scm, as a scenario describes it.
#pragma once

#include <memory>

#include <nlohmann/json_fwd.hpp>

#include "protocol/files/read_context.hpp"
#include "terrain/scm/scm_options.hpp"

namespace furrow::terrain::scm {

/// @pre the section was checked against the schema
std::unique_ptr<TerrainSpec> read_scm_spec(const nlohmann::json& section, const ReadContext& context);

/// The same for a program that has its options already.
std::unique_ptr<TerrainSpec> make_scm_spec(const ScmOptions& options);

}  // namespace furrow::terrain::scm
