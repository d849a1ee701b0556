#include "terrain/gpu/tire_on_gpu.hpp"

#include <algorithm>
#include <utility>

#include "protocol/core/assert.hpp"
#include "terrain/surface/surface_topology.hpp"

namespace furrow::terrain::gpu {
namespace {

constexpr double kSlackShare = 0.5;  // of a grain's radius: vertices move that far before the grid is made anew

using Rows = const std::int32_t (*)[3];

double farthest(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double most2 = 0.0;
  for (std::size_t v = 0; v < a.size(); ++v) most2 = std::max(most2, (a[v] - b[v]).squaredNorm());
  return std::sqrt(most2);
}

}  // namespace

TireOnGpu::TireOnGpu(GpuGrains& grains, int k, const SurfaceMesh& mesh, const ContactMaterial& material,
                     const SurfaceState& start, double radius, SurfacePatches patches)
    : k_(k),
      radius_(radius),
      mesh_(mesh),
      material_(material),
      patches_(std::move(patches)),
      start_(start.position),
      end_(start.position),
      impulse_(start.position.size()) {
  static_assert(sizeof(std::array<int, 3>) == 3 * sizeof(std::int32_t) && sizeof(int) == sizeof(std::int32_t));
  const SurfaceTopology topology(mesh);
  std::vector<std::int32_t> first{0}, patch;
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    const auto of = patches_.of(t);
    patch.insert(patch.end(), of.begin(), of.end());
    first.push_back(static_cast<std::int32_t>(patch.size()));
  }
  Surface s{};
  s.vertices = mesh.vertex_count, s.triangles = static_cast<std::int32_t>(mesh.triangles.size());
  s.triangle = reinterpret_cast<Rows>(mesh.triangles.data());
  s.neighbour = reinterpret_cast<Rows>(topology.neighbour.data());
  s.boundary = topology.boundary_vertex.data();
  s.around_first = topology.first.data(), s.around = topology.incident.data();
  s.patch_first = first.data(), s.patch = patch.data();
  s.position = reinterpret_cast<const double(*)[3]>(end_.data());
  grains.attach(s);
}

SurfaceBox TireOnGpu::swept_box() const {
  SurfaceBox box{end_.front(), end_.front()};
  for (const auto* of : {&start_, &end_})
    for (const Vec3& x : *of) box.lo = box.lo.cwiseMin(x), box.hi = box.hi.cwiseMax(x);
  return box;
}

void TireOnGpu::set_target(const SurfaceState& target, double duration) {
  FURROW_ASSERT(target.position.size() == end_.size() && duration > 0.0, target.position.size(), end_.size(), duration);
  start_.swap(end_);
  for (std::size_t v = 0; v < end_.size(); ++v) end_[v] = target.position[v] + duration * target.velocity[v];
  duration_ = duration;
  fastest_ = farthest(start_, end_) / duration;
}

bool TireOnGpu::grid_fits(const SurfaceBox& grains) const {
  return !built_at_.empty() && (grains.lo.array() >= built_limit_.lo.array()).all() &&
         (grains.hi.array() <= built_limit_.hi.array()).all() && farthest(start_, built_at_) <= slack_ &&
         farthest(end_, built_at_) <= slack_;
}

void TireOnGpu::build_grid(const SurfaceBox& grains) {
  slack_ = kSlackShare * radius_ + farthest(start_, end_);
  built_at_ = start_;
  // The margin allows small changes without a new grid for each.
  built_limit_ = {grains.lo.array() - 2.0 * radius_, grains.hi.array() + 2.0 * radius_};
  const double margin = radius_ + slack_;
  listed_.clear();
  for (int t = 0; t < static_cast<int>(mesh_.triangles.size()); ++t) {
    const auto& v = mesh_.triangles[t];
    const Vec3 lo = start_[v[0]].cwiseMin(start_[v[1]]).cwiseMin(start_[v[2]]).array() - margin;
    const Vec3 hi = start_[v[0]].cwiseMax(start_[v[1]]).cwiseMax(start_[v[2]]).array() + margin;
    if ((lo.array() <= built_limit_.hi.array()).all() && (hi.array() >= built_limit_.lo.array()).all())
      listed_.push_back(t);
  }
  grid_.build(start_, mesh_.triangles, listed_, margin);
}

void TireOnGpu::send(GpuGrains& to, const SurfaceBox& grains) {
  const bool same = grid_fits(grains);
  if (!same) build_grid(grains);
  FacetGrid g{};
  const SurfaceBox box = swept_box();
  for (int a = 0; a < 3; ++a) {
    g.origin[a] = grid_.origin()[a];
    g.cells[a] = grid_.cells()[a];
    g.low[a] = box.lo[a] - radius_, g.high[a] = box.hi[a] + radius_;
  }
  g.inverse_cell = grid_.inverse_cell();
  g.first = grid_.first().data(), g.entry = grid_.entries().data();
  g.listed_count = static_cast<std::int32_t>(listed_.size()), g.listed = listed_.data();
  to.set_surface_motion(k_, end_, duration_, g, same);
}

void TireOnGpu::finish(GpuGrains& from, NodalForces& forces, ContactSums& sums) {
  const SurfaceSums s = from.surface_result(k_, impulse_);
  forces.clear();
  sums = {};
  Vec3 all = Vec3::Zero();
  for (std::size_t v = 0; v < impulse_.size(); ++v) {
    if (impulse_[v].isZero(0.0)) continue;
    forces.vertex.push_back(static_cast<int>(v));
    forces.force.push_back(impulse_[v] / duration_);
    all += impulse_[v];
    sums.work += impulse_[v].dot((end_[v] - start_[v]) / duration_);
  }
  const Vec3 normal(s.normal[0], s.normal[1], s.normal[2]),
      tangential(s.tangential[0], s.tangential[1], s.tangential[2]);
  const Vec3 gap(s.moment_gap[0], s.moment_gap[1], s.moment_gap[2]);
  sums.normal = normal / duration_, sums.tangential = tangential / duration_;
  sums.force = sums.normal + sums.tangential;
  if (s.force_scale > 0.0) sums.transfer_force_residual = (all - normal - tangential).norm() / s.force_scale;
  if (s.moment_scale > 0.0) sums.transfer_moment_residual = gap.norm() / s.moment_scale;
  sums.contacts = s.contacts, sums.sliding = s.sliding;
}

}  // namespace furrow::terrain::gpu
