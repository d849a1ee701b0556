// Numbers in sentences, with as many digits as matter at any scale.
#pragma once

#include <string>

namespace furrow {

/// Three significant digits, and all digits before the point: 1398, 25.3, 0.0253; 0 below 1e-12.
std::string digits(double value);

/// "1398 ± 40", "2.53 ± 0.41": the error has two significant digits, and the value ends at the same decimal place.
std::string with_error(double value, double error);

}  // namespace furrow
