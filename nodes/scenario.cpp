#include "nodes/scenario.hpp"

#include <cmath>

namespace furrow {

std::int64_t RunOptions::steps() const { return std::llround(end / step); }

}  // namespace furrow
