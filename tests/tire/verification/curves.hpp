// Load–deflection curves of the verification suite. With the environment variable FURROW_VERIFICATION_CURVES set, every
// point is appended to that file: case, curve, load, deflection, reference (empty if there is none).
#pragma once

#include <optional>
#include <string>

namespace furrow::verification {

void curve_point(const std::string& test_case, const std::string& curve, double load, double deflection,
                 std::optional<double> reference = {});

}  // namespace furrow::verification
