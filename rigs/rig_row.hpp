// Several rigs side by side on one terrain, each with a wheel or more of its own.
#pragma once

#include <memory>
#include <vector>

#include "rigs/rig.hpp"

namespace furrow::rigs {

/// Wheels are numbered through the rigs in order; each has its own rig's heading.
/// @throws Error(physics) when `rigs` is empty
std::unique_ptr<Rig> make_rig_row(std::vector<std::unique_ptr<Rig>> rigs);

}  // namespace furrow::rigs
