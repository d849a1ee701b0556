// The number of elements of a case, as text.
#pragma once

#include <string>

namespace furrow::test {

inline std::string size(int n, int m) { return std::to_string(n) + " x " + std::to_string(m); }

}  // namespace furrow::test
