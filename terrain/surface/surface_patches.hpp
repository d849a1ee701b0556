// Couples on a triangulated surface. Vertices carry only forces, so a couple M acts on the vertices around its point as
// forces without a resultant. With their positions x_a from their centroid and J = Σ (|x_a|² I − x_a x_aᵀ),
//
//   f_a = (J⁻¹ M) × x_a,     Σ f_a = 0,   Σ x_a × f_a = M,   Σ f_a · v_a = M · ω_s,   ω_s = J⁻¹ Σ x_a × v_a:
//
// force, moment and power are exact for ω_s, the spin of the vertices if they move as a rigid body.
#pragma once

#include <span>
#include <vector>

#include "protocol/core/assert.hpp"
#include "protocol/core/fields.hpp"
#include "protocol/core/surface.hpp"
#include "terrain/surface/patch_turn.hpp"

namespace furrow::terrain {

/// The vertices of each triangle, and more vertices around it if it is small.
class SurfacePatches {
 public:
  SurfacePatches() = default;
  /// @param reach distance from the triangle's centroid within which vertices belong to it, along connected triangles,
  /// m
  /// @pre a position for each vertex
  SurfacePatches(const SurfaceMesh& mesh, std::span<const Vec3> position, double reach);

  std::span<const int> of(int triangle) const {
    FURROW_ASSERT(in_range(triangle + 1, first_.size()), triangle, first_.size());
    return std::span(vertex_).subspan(first_[triangle], first_[triangle + 1] - first_[triangle]);
  }

 private:
  friend void visit_fields(FieldsOf<SurfacePatches> auto& s, auto&& visit) {
    visit(s.first_, Field{"first"});
    visit(s.vertex_, Field{"vertex"});
  }
  std::vector<int> first_, vertex_;
};

/// A couple on a patch, as forces on its vertices.
struct PatchCouple {
  Vec3 moment = Vec3::Zero();  // M, N m
  Vec3 turn = Vec3::Zero();    // J⁻¹ M, N/m
  Vec3 centre = Vec3::Zero();  // of the patch, m

  /// Force on a vertex at x, N.
  Vec3 force_at(const Vec3& x) const { return turn.cross(x - centre); }
};

/// A patch at its present position.
class PatchTurn {
 public:
  /// @pre three vertices or more
  PatchTurn(std::span<const int> patch, std::span<const Vec3> position);

  /// ω_s, rad/s.
  Vec3 spin(std::span<const Vec3> velocity) const;
  /// If the vertices lie on one line, no moment about that line can act.
  PatchCouple couple(const Vec3& moment) const;
  /// −∂f/∂u of one vertex if the others do not move, where M = −K ω: [x]ᵀ J⁻¹ K J⁻¹ [x].
  Mat3 resistance(int vertex, const Mat3& of_couple) const;

 private:
  PatchVertices vertices_;
  PatchVertices::Vector centre_;  // m
  Symmetric inverse_;             // 1/m²
};

}  // namespace furrow::terrain
