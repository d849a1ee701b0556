// The table of kinds that `furrow calibrate` knows. A new kind is one line.
#include <array>

#include "nodes/calibrate/grains.hpp"
#include "nodes/calibrate/handling.hpp"
#include "nodes/calibrate/kind.hpp"
#include "nodes/calibrate/noisy.hpp"
#include "nodes/calibrate/press.hpp"
#include "nodes/calibrate/scm.hpp"
#include "nodes/calibrate/smooth.hpp"

namespace furrow::calibrate {
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

}  // namespace furrow::calibrate
