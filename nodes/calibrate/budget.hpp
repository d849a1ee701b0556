// How many evaluations a calibration of a noisy model takes (noisy.hpp).
#pragma once

#include <cstddef>

namespace furrow::calibrate {

/// What a study of so many parameters needs at least: surrogates with a slope, and a few beside the design.
constexpr int least_evaluations(std::size_t parameters) { return 2 * static_cast<int>(parameters) + 4; }
/// What it takes where the study says nothing.
constexpr int usual_evaluations(std::size_t parameters) { return 6 * static_cast<int>(parameters) + 4; }

}  // namespace furrow::calibrate
