// Heights of ground that nothing deforms, for tires that compute their contact by a law of their own.
#pragma once

#include <array>
#include <functional>
#include <vector>

namespace furrow {

/// z at a place, m; empty: the plane z = 0. Any thread may call it.
using GroundHeights = std::function<double(double x, double y)>;
/// Heights that are alike for all y: corners [x, z], m, x not decreasing; level before the first and after the last.
/// Empty: the plane z = 0.
using GroundProfilePoints = std::vector<std::array<double, 2>>;

}  // namespace furrow
