#include "terrain/surface/surface_patches.hpp"

#include <algorithm>

#include "terrain/surface/surface_topology.hpp"
#include "terrain/surface/surface_vectors.hpp"

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

PatchTurn::PatchTurn(std::span<const int> patch, std::span<const Vec3> position)
    : vertices_{patch.data(), static_cast<int>(patch.size()), flat(position)},
      centre_(vertices_.centre()),
      inverse_(vertices_.inverse(centre_)) {
  FURROW_ASSERT(patch.size() >= 3, patch.size());
}

Vec3 PatchTurn::spin(std::span<const Vec3> velocity) const {
  return vec(vertices_.spin(centre_, inverse_, flat(velocity)));
}

PatchCouple PatchTurn::couple(const Vec3& moment) const {
  return {moment, vec(vertices_.solved(centre_, inverse_, triple(moment))), vec(centre_)};
}

Mat3 PatchTurn::resistance(int vertex, const Mat3& of_couple) const {
  const Symmetric& j = inverse_;
  Mat3 inverse;
  inverse << j.xx, j.xy, j.xz, j.xy, j.yy, j.yz, j.xz, j.yz, j.zz;
  const Mat3 turn = inverse * cross_matrix(vec(PatchVertices::of(vertices_.position, vertex) - centre_));
  return turn.transpose() * of_couple * turn;
}

}  // namespace furrow::terrain
