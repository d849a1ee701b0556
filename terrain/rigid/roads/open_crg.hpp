// Measured roads in the format ASAM OpenCRG 1.2: heights on a grid, u along a reference line and v to its left.
//
// Read are the road parameters, the data definition and the road data in the four formats (LRFI and LDFI as text, KRBI
// and KDBI as big-endian numbers). Of the reference line the headings are read; its position and that of the Earth are
// left out. Its slope and banking are added to the heights. Options and
// modifiers that change the heights are honoured or refused by name (crg_settings.hpp), references to other files are
// refused. A length of the data that does not fit the header or the records of 80 bytes is refused: bytes lost in
// transfer shift all numbers behind them.
//
// ASAM OpenCRG 1.2.0, chapter 6, "OpenCRG data format".
#pragma once

#include <filesystem>
#include <vector>

#include "terrain/rigid/ground_profile.hpp"

namespace furrow::terrain {

struct OpenCrg {
  double start = 0.0, increment = 0.0;  // u of the first cross-section, distance of two, m
  std::vector<double> v;                // of the longitudinal cuts, rising, m
  std::vector<double> heights;          // (cross-sections, cuts), m; NaN beside the road
  std::vector<double> headings;         // of the reference line to each cross-section but the first, from 0 on, rad
  double turn = 0.0;                    // from the least heading to the largest, rad

  std::size_t count() const { return v.empty() ? 0 : heights.size() / v.size(); }
};

/// @throws Error(bad_input) naming the file, its line or cross-section, and what was expected
OpenCrg read_open_crg(const std::filesystem::path& file);

/// The cut at v, straight between the two beside it.
/// @throws Error(bad_input) where the road has no height at v. @param file for messages
ProfilePoints profile_of(const OpenCrg& road, double v, const std::filesystem::path& file);

}  // namespace furrow::terrain
