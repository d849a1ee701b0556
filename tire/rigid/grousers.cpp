#include "tire/rigid/grousers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "protocol/core/assert.hpp"

namespace furrow::tire {

void add_grousers(TireShape& shape, int number, double height, double thickness) {
  FURROW_ASSERT(number >= 1 && height > 0.0 && thickness > 0.0 && height < shape.radius &&
                    number * thickness < 2.0 * std::numbers::pi * shape.radius,
                number, height, thickness, shape.radius);
  const int first = static_cast<int>(shape.vertex.size()) - 2, added = number * kGrouserVertices;
  for (auto& triangle : shape.mesh.triangles)
    for (int& corner : triangle)
      if (corner >= first) corner += added;
  const std::span wheel = std::span(shape.vertex).first(static_cast<std::size_t>(first));
  std::array<double, kGrouserCells + 1> across, radius;  // of a plate's vertices: y, and the tread there
  for (std::size_t i = 0; i < across.size(); ++i) {
    const double y = across[i] = (0.5 - static_cast<double>(i) / kGrouserCells) * shape.tread_width;
    const Vec3 nearest = std::ranges::min(wheel, {}, [y](const Vec3& x) { return std::abs(x.y() - y); });
    radius[i] = std::hypot(nearest.x(), nearest.z());
  }
  std::vector<Vec3> plates;
  for (int k = 0; k < number; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / number;
    const Vec3 outward(std::sin(angle), 0.0, std::cos(angle)), along(std::cos(angle), 0.0, -std::sin(angle));
    const int base = first + k * kGrouserVertices;
    const auto at = [&](int i, int front, int tip) { return base + 4 * i + 2 * front + tip; };
    const auto quad = [&](int a, int b, int c, int d) {
      shape.mesh.triangles.push_back({a, b, c});
      shape.mesh.triangles.push_back({a, c, d});
    };
    for (std::size_t i = 0; i < across.size(); ++i)
      for (const double side : {-0.5, 0.5})
        for (const double beyond : {-height, height})
          plates.push_back((radius[i] + beyond) * outward + side * thickness * along + across[i] * Vec3::UnitY());
    for (int i = 0; i < kGrouserCells; ++i) {
      quad(at(i, 1, 0), at(i, 1, 1), at(i + 1, 1, 1), at(i + 1, 1, 0));  // ahead
      quad(at(i + 1, 0, 0), at(i + 1, 0, 1), at(i, 0, 1), at(i, 0, 0));  // behind
      quad(at(i + 1, 0, 1), at(i + 1, 1, 1), at(i, 1, 1), at(i, 0, 1));  // tip
    }
    const int last = kGrouserCells;
    quad(at(0, 0, 0), at(0, 0, 1), at(0, 1, 1), at(0, 1, 0));
    quad(at(last, 1, 0), at(last, 1, 1), at(last, 0, 1), at(last, 0, 0));
  }
  shape.vertex.insert(shape.vertex.end() - 2, plates.begin(), plates.end());
  shape.mesh.vertex_count += added;
  shape.tread_vertices = first;
}

}  // namespace furrow::tire
