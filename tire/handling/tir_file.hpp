// Tire property files (.tir): the public text layout with sections of lines NAME = VALUE, as MF-Tyre 5.2, PAC2002 (with
// [TIRE_CONDITIONS]) and Magic Formula 6.1 and 6.2 have it.
//
//   $ or ! begins a comment, * or # at its head makes one of a line, [NAME] a section, { or ( a block that is read over
//   up to the next section. Text stands in single or double quotes. Bytes that are not UTF-8 may stand in comments.
//
// Required: [UNITS] in SI, [MODEL], [DIMENSION], [VERTICAL], the four ranges, [LONGITUDINAL_COEFFICIENTS],
// [LATERAL_COEFFICIENTS] and in them what scales the forces. Other coefficients are 0 where a file leaves them out or
// empty, PKY4 2, QSY7 of 6.1 1, scaling factors 1. What a user must know is left in MagicFormula::remarks: ranges that
// are not taken as they stand, and in one line all unknown names whose values would change a result (not 0, of a
// scaling factor not 1). Sections of other names may hold any text and are passed over, but [BOTTOMING_CURVE] and
// [TURNSLIP_COEFFICIENTS] are named there. Sources: TNO Automotive, MF-Tyre User Manual, version 5.2, 2001; MSC
// Software, Adams/Tire: Using the PAC2002 tire model; appendix 3 of Pacejka, Tire and Vehicle Dynamics, 2012.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tire/handling/coefficients.hpp"

namespace furrow::tire::handling {

/// @throws Error(bad_input) naming file, section and key: unknown units, another version, what is missing (all of it),
/// given twice, not finite or out of its range
MagicFormula read_tir(const std::filesystem::path& file);
/// The same of a text. @param name of the file, for messages
MagicFormula parse_tir(const std::string& text, const std::string& name);

/// What read_tir reads back bit for bit. @param comments lines for the head of the file, without marks
std::string tir_text(const MagicFormula& tire, const std::vector<std::string>& comments);

}  // namespace furrow::tire::handling
