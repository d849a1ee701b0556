// Values of a tire file that seem to be in a wrong unit.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "tire/tire_file.hpp"

namespace furrow::tire {

/// Keys and what is odd about their values, for values that no tire has: densities, stiffnesses, thicknesses, angles
/// and pressures in other units than SI. The tire can still be used.
std::vector<std::pair<std::string, std::string>> unlikely_values(const TireFile& file);

}  // namespace furrow::tire
