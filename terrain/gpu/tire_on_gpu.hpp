// The surface of a tire among grains on a GPU: what the processor prepares for an interval, and what it makes of the
// impulses afterwards.
#pragma once

#include <vector>

#include "protocol/core/surface.hpp"
#include "protocol/core/terrain_state.hpp"
#include "terrain/dem/contact/laws.hpp"
#include "terrain/gpu/gpu_grains.hpp"
#include "terrain/surface/surface_collider.hpp"
#include "terrain/surface/surface_grid.hpp"
#include "terrain/surface/surface_patches.hpp"

namespace furrow::terrain::gpu {

class TireOnGpu {
 public:
  /// Attaches the surface to the grains. @param k its number there @param radius of the grains, m
  TireOnGpu(GpuGrains& grains, int k, const SurfaceMesh& mesh, const ContactMaterial& material,
            const SurfaceState& start, double radius, SurfacePatches patches);

  std::size_t vertices() const { return end_.size(); }
  const SurfaceMesh& mesh() const { return mesh_; }
  const ContactMaterial& material() const { return material_; }
  const SurfacePatches& patches() const { return patches_; }
  const std::vector<Vec3>& position() const { return end_; }
  SurfaceBox swept_box() const;
  /// Fastest vertex of the interval, m/s.
  double fastest() const { return fastest_; }

  /// Sets the motion of the coming interval, on this side only.
  void set_target(const SurfaceState& target, double duration);
  /// Sends it to the GPU. @param grains box that contains all grains in the interval, m
  void send(GpuGrains& to, const SurfaceBox& grains);
  /// Means over the interval.
  void finish(GpuGrains& from, NodalForces& forces, ContactSums& sums);

 private:
  bool grid_fits(const SurfaceBox& grains) const;
  void build_grid(const SurfaceBox& grains);

  int k_;
  double radius_;
  SurfaceMesh mesh_;
  ContactMaterial material_;
  SurfacePatches patches_;
  std::vector<Vec3> start_, end_;  // of the interval, m
  double duration_ = 1.0, fastest_ = 0.0;
  SurfaceGrid grid_;
  std::vector<Vec3> built_at_;  // positions with which the grid was made
  double slack_ = 0.0;          // by which vertices may leave them, m
  SurfaceBox built_limit_;
  std::vector<int> listed_;  // triangles in the grid
  std::vector<Vec3> impulse_;
};

}  // namespace furrow::terrain::gpu
