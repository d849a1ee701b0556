// Several rigs side by side on one terrain, each with one wheel.
#pragma once

#include <memory>
#include <vector>

#include "rigs/rig.hpp"

namespace furrow::rigs {

/// Wheel k is the wheel of the k-th rig and has its heading; other subjects of the rigs are left out.
/// @pre there is at least one, and each has one wheel
std::unique_ptr<Rig> make_rig_row(std::vector<std::unique_ptr<Rig>> rigs);

}  // namespace furrow::rigs
