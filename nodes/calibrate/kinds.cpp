#include "nodes/calibrate/kinds.hpp"

namespace furrow::calibrate {

const std::vector<CalibrationKind>& calibration_kinds() {
  static const std::vector<CalibrationKind> kinds{ring_kind(), handling_kind(), planar_kind(), scm_kind(),
                                                  grain_kind()};
  return kinds;
}

}  // namespace furrow::calibrate
