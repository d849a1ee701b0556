#include "tire/surface_strain.hpp"

#include <algorithm>
#include <cmath>

#include "protocol/core/assert.hpp"

namespace furrow::tire {

std::vector<float> surface_strain(const SurfaceMesh& mesh, const std::vector<Vec3>& undeformed,
                                  const std::vector<Vec3>& position) {
  FURROW_ASSERT(undeformed.size() == position.size(), undeformed.size(), position.size());
  const auto metric = [](const std::vector<Vec3>& x, const std::array<int, 3>& corner) {
    const Vec3 e = x[corner[1]] - x[corner[0]], f = x[corner[2]] - x[corner[0]];
    Eigen::Matrix2d g;
    g << e.dot(e), e.dot(f), e.dot(f), f.dot(f);
    return g;
  };
  std::vector<double> sum(position.size(), 0.0), area(position.size(), 0.0);
  for (const std::array<int, 3>& corner : mesh.triangles) {
    const Eigen::Matrix2d before = metric(undeformed, corner);
    const Eigen::Matrix2d e = 0.5 * before.inverse() * (metric(position, corner) - before);
    const double middle = 0.5 * e.trace();
    const double largest = middle + std::sqrt(std::max(0.0, middle * middle - e.determinant()));
    const double weight = std::sqrt(before.determinant());
    for (const int vertex : corner) {
      sum[vertex] += weight * largest;
      area[vertex] += weight;
    }
  }
  std::vector<float> strain(position.size(), 0.0F);
  for (std::size_t v = 0; v < strain.size(); ++v)
    if (area[v] > 0.0) strain[v] = static_cast<float>(sum[v] / area[v]);
  return strain;
}

}  // namespace furrow::tire
