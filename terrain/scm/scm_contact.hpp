// One surface on the grid of empirical soil: which nodes it presses, with what force, and what that costs.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "protocol/core/fields.hpp"
#include "protocol/core/surface.hpp"
#include "protocol/core/vec.hpp"
#include "terrain/scm/contact_patch.hpp"
#include "terrain/scm/footprint.hpp"
#include "terrain/scm/janosi_shear.hpp"
#include "terrain/scm/pressure_sinkage.hpp"
#include "terrain/surface/surface_forces.hpp"

namespace furrow::terrain::scm {

/// Since the run began, J.
struct SoilLosses {
  double compaction = 0.0;  // and heave
  double damping = 0.0;     // of the rebound
  double sliding = 0.0;
  double opening = 0.0;  // springs and shear given up where loads change and end
};
void visit_fields(FieldsOf<SoilLosses> auto& s, auto&& visit) {
  visit(s.compaction, Field{"compaction", "J"});
  visit(s.damping, Field{"damping", "J"});
  visit(s.sliding, Field{"sliding", "J"});
  visit(s.opening, Field{"opening", "J"});
}

/// A node that bears a surface.
struct ContactNode {
  std::int32_t node = -1;
  double sinkage = 0.0;           // of the surface, m
  double limit = 0.0;             // τ_max × A/|n_z|, N
  Vec3 mobilized = Vec3::Zero();  // m, along the surface
};
void visit_fields(FieldsOf<ContactNode> auto& s, auto&& visit) {
  visit(s.node, Field{"node"});
  visit(s.sinkage, Field{"sinkage", "m"});
  visit(s.limit, Field{"limit", "N"});
  visit(s.mobilized, Field{"mobilized", "-"});
}

/// The grid with what every surface on it shares.
class SoilField {
 public:
  /// @param ground heights before the run at the nodes, m; none: all are 0
  SoilField(const Grid& grid, const PressureLaw& law, double patch_width, std::vector<double> ground = {});

  /// One step of a surface at `now`. Replaces `bearing`, the nodes of the step before, by those of this one and fills
  /// `contacts` with their forces on the surface. @param shear with the friction of this surface
  void step(const SurfaceNow& now, const ShearLaw& shear, double dt, std::vector<ContactNode>& bearing,
            std::vector<SurfaceContactForce>& contacts, SoilLosses& losses);

  /// Energy of the springs under these nodes, and of their shear, J.
  double pressed(std::span<const ContactNode> bearing) const;
  double sheared(const ShearLaw& shear, std::span<const ContactNode> bearing) const;

  const Grid& grid() const { return grid_; }
  std::vector<SoilNode>& nodes() { return node_; }
  const std::vector<SoilNode>& nodes() const { return node_; }
  double height(int node) const { return finder_.ground(node) - node_[node].plastic; }  // of the surface now, m

 private:
  void find_moduli();
  ContactNode bear(const NodeHit& hit, double modulus, const Vec3& velocity, const ShearLaw& shear, double dt,
                   SurfaceContactForce& contact, SoilLosses& losses);
  SurfaceContactTangent tangent(const Vec3& normal, double area, const SoilNode& node, double pressure,
                                const ShearLaw& shear, const ContactNode& now) const;
  Vec3 carried(int node, const Vec3& velocity, double dt) const;
  void release(const ShearLaw& shear, SoilLosses& losses);
  double spring(const ContactNode& at) const;

  Grid grid_;
  PressureLaw law_;
  double patch_width_;  // m; negative: of each patch
  FootprintFinder finder_;
  std::vector<SoilNode> node_;
  // Of the running step.
  std::vector<NodeHit> hits_;
  std::vector<int> touching_;  // places in hits_
  std::vector<Cell> cells_;    // of those
  PatchFinder patches_;
  std::vector<double> of_patch_;  // Bekker's k
  std::vector<double> modulus_;   // of each touching node
  std::vector<ContactNode> before_;
  std::vector<std::int32_t> mark_;  // of each node: its place in before_, or one of the two values below
  static constexpr std::int32_t kUncovered = -1, kCovered = -2;
};

}  // namespace furrow::terrain::scm
