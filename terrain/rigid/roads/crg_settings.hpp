// The settings NAME = number in the header of an OpenCRG file: which there are, and which of them are honoured.
//
// ASAM OpenCRG 1.2.0, chapter 6, "OpenCRG data format"; chapters 7 and 8, options and modifiers.
#pragma once

#include <string>

namespace furrow::terrain {

/// Whether a section holds settings: ROAD_CRG, ROAD_CRG_OPTS or ROAD_CRG_MODS.
bool has_crg_settings(const std::string& section);

/// What is wrong with a setting, "is 3, expected 2: …"; empty: it is honoured, or cannot change the heights.
/// @param name in capitals @pre has_crg_settings(section)
std::string crg_setting_fault(const std::string& section, const std::string& name, double value);

}  // namespace furrow::terrain
