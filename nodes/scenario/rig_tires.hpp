// The tires of a scenario whose rig brings its own: those of its wheels, changed by the scenario.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace furrow::scenario {

/// Puts one complete entry per wheel into `tires`. The entries replace a `tire` that changes all wheels, or entries
/// that change each wheel or axle. Does nothing if the rig brings no tires.
/// @pre the document is an object; none of it was checked. @throws Error(bad_input)
void fill_rig_tires(nlohmann::json& document, const std::string& file);

}  // namespace furrow::scenario
