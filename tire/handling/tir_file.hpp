// Tire property files (.tir): the public text layout of MF-Tyre 5.2 with sections of lines NAME = VALUE.
//
//   $ or ! begins a comment, [NAME] a section, {NAME …} a table (of [SHAPE]: read over). Text stands in quotes.
//
// Required: [UNITS] in SI, [MODEL], [DIMENSION], [VERTICAL], the four ranges, [LONGITUDINAL_COEFFICIENTS],
// [LATERAL_COEFFICIENTS] and in them what scales the forces. Other coefficients are 0 where a file leaves them out,
// scaling factors 1. In these sections and in those of coefficients an unknown name is an error; other sections are
// passed over. Source: TNO Automotive, MF-Tyre User Manual, version 5.2, 2001.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tire/handling/coefficients.hpp"

namespace furrow::tire::handling {

/// @throws Error(bad_input) naming file, section and key: unknown units, another version, what is missing, given twice,
/// not finite or out of its range
MagicFormula read_tir(const std::filesystem::path& file);
/// The same of a text. @param name of the file, for messages
MagicFormula parse_tir(const std::string& text, const std::string& name);

/// What read_tir reads back bit for bit. @param comments lines for the head of the file, without marks
std::string tir_text(const MagicFormula& tire, const std::vector<std::string>& comments);

}  // namespace furrow::tire::handling
