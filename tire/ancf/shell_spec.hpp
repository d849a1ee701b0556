// The layered shell tire as an entry of the table of models: its file, a scenario's changes of it, its description.
#pragma once

#include <memory>

#include <nlohmann/json_fwd.hpp>

#include "tire/tire_file.hpp"
#include "tire/tire_spec.hpp"

namespace furrow::tire {

/// The tire file with the scenario's choices instead of its own. @throws Error(bad_input)
TireFile tire_file_of(const TireOptions& options, TireFile file);

/// The undeformed shell: nodes of the mid-surface, then the centres of the bead discs. @throws Error(bad_input)
TireShape shell_shape(const TireFile& file);

/// @throws Error(bad_input) naming file and key
std::unique_ptr<TireSpec> read_shell(const nlohmann::json& file, const TireOptions& options);

}  // namespace furrow::tire
