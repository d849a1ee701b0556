#include "tire/cylinder.hpp"

#include <cmath>
#include <numbers>

#include "protocol/core/assert.hpp"

namespace furrow::tire {

TireShape cylinder(int n, double radius, double width, int rows) {
  FURROW_ASSERT(n >= 3 && rows >= 2 && radius > 0.0 && width > 0.0, n, rows, radius, width);
  TireShape shape;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < rows; ++i) {
      const double angle = 2.0 * std::numbers::pi * j / n, side = 0.5 - static_cast<double>(i) / (rows - 1);
      shape.vertex.emplace_back(radius * std::sin(angle), side * width, radius * std::cos(angle));
    }
  shape.vertex.emplace_back(0.0, 0.5 * width, 0.0);
  shape.vertex.emplace_back(0.0, -0.5 * width, 0.0);
  for (int j = 0; j < n; ++j) {
    const int first = rows * j, next = rows * ((j + 1) % n);
    for (int i = 0; i + 1 < rows; ++i) {
      const int left = first + i, right = left + 1, next_left = next + i, next_right = next_left + 1;
      shape.mesh.triangles.push_back({right, next_right, left});
      shape.mesh.triangles.push_back({next_right, next_left, left});
    }
    shape.mesh.triangles.push_back({first, next, rows * n});
    shape.mesh.triangles.push_back({next + rows - 1, first + rows - 1, rows * n + 1});
  }
  shape.mesh.vertex_count = rows * n + 2;
  shape.radius = radius;
  shape.tread_width = width;
  return shape;
}

}  // namespace furrow::tire
