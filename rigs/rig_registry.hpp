// Rig types by the name that a scenario gives them.
#pragma once

#include <memory>
#include <string>

#include "rigs/drawbar_rig.hpp"
#include "rigs/rig.hpp"

namespace furrow::rigs {

/// @throws Error(bad_input) for an unknown type, listing the valid ones.
std::unique_ptr<Rig> make_rig(const std::string& type, const DrawbarRigOptions& options);

}  // namespace furrow::rigs
