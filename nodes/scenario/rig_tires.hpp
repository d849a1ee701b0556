// The tires of a scenario whose rig brings its own: what its wheels name, changed by what the scenario says.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace furrow::scenario {

/// Puts one complete entry per wheel into `tires`, in place of a `tire` that changes all of them and of entries that
/// change each wheel's, or each axle's. Leaves scenarios alone whose rig brings no tires.
/// @pre the document is an object; nothing of it was checked. @throws Error(bad_input)
void fill_rig_tires(nlohmann::json& document, const std::string& file);

}  // namespace furrow::scenario
