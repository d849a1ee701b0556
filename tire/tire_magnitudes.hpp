// Values of a tire file that look like another unit.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "tire/tire_file.hpp"

namespace furrow::tire {

/// Key and what is odd about its value, for values that no tire has: densities, stiffnesses, thicknesses, angles and
/// pressures in other units than SI. None of them keeps a tire from being used.
std::vector<std::pair<std::string, std::string>> unlikely_values(const TireFile& file);

}  // namespace furrow::tire
