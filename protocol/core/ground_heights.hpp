// Heights of ground that nothing deforms, for tires that compute their contact by a law of their own.
#pragma once

#include <functional>

namespace furrow {

/// z at a place, m; empty: the plane z = 0. Any thread may call it.
using GroundHeights = std::function<double(double x, double y)>;

}  // namespace furrow
