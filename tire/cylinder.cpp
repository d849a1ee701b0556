#include "tire/cylinder.hpp"

#include <cmath>
#include <numbers>

#include "protocol/core/assert.hpp"

namespace furrow::tire {

TireShape cylinder(int n, double radius, double width) {
  FURROW_ASSERT(n >= 3 && radius > 0.0 && width > 0.0, n, radius, width);
  TireShape shape;
  for (int j = 0; j < n; ++j)
    for (const double side : {0.5, -0.5}) {
      const double angle = 2.0 * std::numbers::pi * j / n;
      shape.vertex.emplace_back(radius * std::sin(angle), side * width, radius * std::cos(angle));
    }
  shape.vertex.emplace_back(0.0, 0.5 * width, 0.0);
  shape.vertex.emplace_back(0.0, -0.5 * width, 0.0);
  for (int j = 0; j < n; ++j) {
    const int left = 2 * j, right = left + 1, next_left = 2 * ((j + 1) % n), next_right = next_left + 1;
    shape.mesh.triangles.push_back({right, next_right, left});
    shape.mesh.triangles.push_back({next_right, next_left, left});
    shape.mesh.triangles.push_back({left, next_left, 2 * n});
    shape.mesh.triangles.push_back({next_right, right, 2 * n + 1});
  }
  shape.mesh.vertex_count = 2 * n + 2;
  shape.radius = radius;
  shape.tread_width = width;
  return shape;
}

}  // namespace furrow::tire
