// The table of kinds that `furrow calibrate` knows. A new kind is one line.
#include <array>

#include "nodes/study/calibrate_grains.hpp"
#include "nodes/study/calibrate_handling.hpp"
#include "nodes/study/calibrate_kind.hpp"
#include "nodes/study/calibrate_noisy.hpp"
#include "nodes/study/calibrate_press.hpp"
#include "nodes/study/calibrate_scm.hpp"
#include "nodes/study/calibrate_smooth.hpp"

namespace furrow::study {
namespace {

constexpr auto kKinds = std::to_array<CalibrationKind>({
    {"ring", "a tire file", ring_parameters, read_ring_calibration, optimize_smooth},
    {"handling", "a tire property file (.tir)", handling_parameters, read_handling_calibration, optimize_smooth},
    {"planar", "a tire file", planar_parameters, read_planar_calibration, optimize_smooth},
    {"scm", "a soil file", scm_parameters, read_scm_calibration, optimize_smooth},
    {"grains", "a scenario with grains", grain_parameters, read_grain_calibration, optimize_noisy, true, kGrainKeys,
     grain_quantities},
});

}  // namespace

std::span<const CalibrationKind> calibration_kinds() { return kKinds; }

}  // namespace furrow::study
