// The planar finite-element tire as an entry of the table of models: its file, a scenario's changes of it, its
// description.
#pragma once

#include <memory>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "tire/planar/planar_file.hpp"
#include "tire/tire_spec.hpp"

namespace furrow::tire {

/// @throws Error(bad_input) naming file and key
PlanarFile read_planar_file(const nlohmann::json& file, const std::string& path);

/// @throws Error(bad_input) naming file and key
std::unique_ptr<TireSpec> read_planar(const nlohmann::json& file, const TireOptions& options);

}  // namespace furrow::tire
