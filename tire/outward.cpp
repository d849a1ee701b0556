#include "tire/outward.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"

namespace furrow::tire {

void require_outward(const SurfaceMesh& mesh, std::span<const Vec3> position, const Vec3& centre,
                     const std::string& who) {
  const auto refuse = [&](const std::string& what) { return input_error(who, "", "the contact surface " + what); };
  double volume = 0.0;                     // six times (1), m³
  std::vector<std::pair<int, int>> edges;  // in the direction of their triangles
  for (const auto& triangle : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      if (!in_range(triangle[k], position.size()))
        throw refuse(fmt::format("has a triangle with vertex {}, expected 0 to {}", triangle[k],
                                 static_cast<int>(position.size()) - 1));
      edges.emplace_back(triangle[k], triangle[(k + 1) % 3]);
    }
    const Vec3 a = position[triangle[0]] - centre, b = position[triangle[1]] - centre,
               c = position[triangle[2]] - centre;
    volume += a.dot(b.cross(c));
  }
  std::sort(edges.begin(), edges.end());
  const auto twice = std::adjacent_find(edges.begin(), edges.end());
  if (twice != edges.end())
    throw refuse(
        fmt::format("has two triangles that run from vertex {} to vertex {}, expected neighbours that run "
                    "counter-clockwise seen from outside",
                    twice->first, twice->second));
  if (!(volume > 0.0))
    throw refuse(
        fmt::format("encloses a volume of {:.3g} m³ about the wheel's centre, expected one above 0: "
                    "triangles run counter-clockwise seen from outside",
                    volume / 6.0));
}

}  // namespace furrow::tire
