// Rim states and wrenches in a saved state, bit for bit.
#pragma once

#include <string>

#include "protocol/core/archive.hpp"
#include "protocol/core/surface.hpp"

namespace furrow::tire {

void save_rim(Archive& archive, const std::string& name, const RimState& rim);
RimState restore_rim(const Archive& archive, const std::string& name);
void save_wrench(Archive& archive, const std::string& name, const Wrench& wrench);
Wrench restore_wrench(const Archive& archive, const std::string& name);

}  // namespace furrow::tire
