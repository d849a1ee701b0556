// Numbers in sentences: as many digits as matter, whatever their scale.
#pragma once

#include <string>

namespace furrow {

/// Three significant digits, and all of those before the point: 1398, 25.3, 0.0253; 0 below 1e-12.
std::string digits(double value);

/// "1398 ± 40", "2.53 ± 0.41": the error with two significant digits, and the value down to the same place.
std::string with_error(double value, double error);

}  // namespace furrow
