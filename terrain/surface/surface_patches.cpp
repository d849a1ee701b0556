#include "terrain/surface/surface_patches.hpp"

#include <algorithm>
#include <limits>

#include <Eigen/Eigenvalues>

#include "terrain/surface/surface_topology.hpp"

namespace furrow::terrain {
namespace {

Mat3 cross_matrix(const Vec3& x) {
  Mat3 m;
  m << 0.0, -x.z(), x.y(), x.z(), 0.0, -x.x(), -x.y(), x.x(), 0.0;
  return m;
}

}  // namespace

SurfacePatches::SurfacePatches(const SurfaceMesh& mesh, std::span<const Vec3> position, double reach) {
  FURROW_ASSERT(position.size() == static_cast<std::size_t>(mesh.vertex_count), position.size(), mesh.vertex_count);
  FURROW_ASSERT(reach > 0.0, reach);
  const SurfaceTopology topology(mesh);
  first_.assign(1, 0);
  for (const auto& triangle : mesh.triangles) {
    const Vec3 centroid = (position[triangle[0]] + position[triangle[1]] + position[triangle[2]]) / 3.0;
    std::vector<int> patch(triangle.begin(), triangle.end());
    for (std::size_t k = 0; k < patch.size(); ++k)
      for (const int around : topology.around(patch[k]))
        for (const int v : mesh.triangles[around])
          if ((position[v] - centroid).norm() < reach && std::find(patch.begin(), patch.end(), v) == patch.end())
            patch.push_back(v);
    vertex_.insert(vertex_.end(), patch.begin(), patch.end());
    first_.push_back(static_cast<int>(vertex_.size()));
  }
}

PatchTurn::PatchTurn(std::span<const int> patch, std::span<const Vec3> position) : patch_(patch), position_(position) {
  FURROW_ASSERT(patch.size() >= 3, patch.size());
  for (const int v : patch) centre_ += position[v];
  centre_ /= static_cast<double>(patch.size());
  Mat3 j = Mat3::Zero();
  for (const int v : patch) {
    const Vec3 x = position[v] - centre_;
    j += x.squaredNorm() * Mat3::Identity() - x * x.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Mat3> axes(j);
  const Vec3& values = axes.eigenvalues();
  for (int k = 0; k < 3; ++k)
    if (values[k] > 4.0 * std::numeric_limits<double>::epsilon() * values[2])
      inverse_ += axes.eigenvectors().col(k) * axes.eigenvectors().col(k).transpose() / values[k];
}

Vec3 PatchTurn::spin(std::span<const Vec3> velocity) const {
  Vec3 circulation = Vec3::Zero();
  for (const int v : patch_) circulation += (position_[v] - centre_).cross(velocity[v]);
  return solved(circulation);
}

Vec3 PatchTurn::moment_of(const Vec3& turn) const {
  Vec3 moment = Vec3::Zero();
  for (const int v : patch_) {
    const Vec3 x = position_[v] - centre_;
    moment += x.cross(turn.cross(x));
  }
  return moment;
}

Mat3 PatchTurn::resistance(int vertex, const Mat3& of_couple) const {
  const Mat3 turn = inverse_ * cross_matrix(position_[vertex] - centre_);
  return turn.transpose() * of_couple * turn;
}

}  // namespace furrow::terrain
