// The kinds of `furrow calibrate`. A new kind is a source with its class, a declaration here and a line in kinds.cpp.
#pragma once

#include <vector>

#include "nodes/calibrate/kind.hpp"

namespace furrow::calibrate {

CalibrationKind ring_kind();      // press.cpp
CalibrationKind planar_kind();    // press.cpp
CalibrationKind handling_kind();  // handling.cpp
CalibrationKind scm_kind();       // scm.cpp
CalibrationKind grain_kind();     // grains.cpp

const std::vector<CalibrationKind>& calibration_kinds();

}  // namespace furrow::calibrate
