// Tables of forces against slips in the text layout of TYDEX, release 1.3 (Tyre Data Exchange format; H.-J. Unrau, J.
// Zamow (eds.), TYDEX-Format, description and reference manual, release 1.3, University of Karlsruhe 1997): W-axes, SI
// units. A line of the head has its name in columns 1 to 10, what it is up to 40, the unit up to 50, then the value; of
// a channel three numbers follow, for measured · factor + offsets.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "tire/handling/sweep_table.hpp"

namespace furrow::tire::handling {

/// @param name of the tire and of the measurement @param comments lines of **COMMENTS
std::string tydex_text(const std::string& name, const MagicFormula& tire, std::span<const SweepPoint> points,
                       const std::vector<std::string>& comments);

}  // namespace furrow::tire::handling
