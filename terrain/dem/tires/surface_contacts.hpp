// Contacts of grains with the moving surfaces of tires: finds touched points, applies the grains' law there, and
// collects the forces on the surfaces.
//
// History is stored per (grain, surface). Each touched point takes over the history of that earlier point of the same
// grain and surface whose normal is nearest (within 60°). So no history is lost from triangle to triangle, or where a
// crease splits one point into two; it ends when the grain leaves the surface.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "protocol/core/assert.hpp"
#include "terrain/dem/strips.hpp"
#include "terrain/dem/tires/tire_surface.hpp"

namespace furrow::terrain::dem {

struct SurfaceHistory {
  std::int32_t grain = 0;
  std::int32_t surface = 0;
  Quad normal;      // of the previous step
  Quad tangential;  // spring force on the grain, N; w = √δ
  Quad rolling;     // N m
};
void visit_fields(FieldsOf<SurfaceHistory> auto& s, auto&& visit) {
  visit(s.grain, Field{"grain"});
  visit(s.surface, Field{"surface"});
  visit(s.normal, Field{"normal"});
  visit(s.tangential, Field{"tangential", "N"});
  visit(s.rolling, Field{"rolling", "N m"});
}

struct SurfaceTouch {
  std::int32_t surface = 0;
  SurfaceContactForce force;
};

/// Surface contacts of the grains of one strip, in ascending order of grain, then surface.
struct SurfaceStrip {
  std::vector<SurfaceHistory> history, next;
  std::vector<SurfaceTouch> touches;
  std::vector<std::uint8_t> taken;  // if losses are wanted: histories that a point has taken over
};

class SurfaceContacts {
 public:
  /// grain: that of the coefficients; largest: radius of the largest grain, m.
  SurfaceContacts(const GrainProperties& grain, double largest, LawKind law, bool rolling)
      : grain_(grain), largest_(largest), law_(law), rolling_(rolling) {}

  /// @pre start has the mesh's vertex count.
  void attach(const SurfaceMesh& mesh, const ContactMaterial& material, const ContactCoefficients& coefficients,
              const SurfaceState& start);
  /// Whether surfaces attached from now on get contact tangents with their forces.
  void give_tangents(bool yes) { tangents_ = yes; }
  int count() const { return static_cast<int>(surfaces_.size()); }
  std::size_t vertices(int k) const {
    FURROW_ASSERT(in_range(k, count()), k, count());
    return surfaces_[k].end.size();
  }
  bool any() const { return !surfaces_.empty(); }
  const ContactMaterial& material(int k) const {
    FURROW_ASSERT(in_range(k, count()), k, count());
    return surfaces_[k].material;
  }
  void set_coefficients(int k, const ContactCoefficients& c) {
    FURROW_ASSERT(in_range(k, count()), k, count());
    surfaces_[k].coefficients = c;
    rolling_ |= with_law(law_, [&](auto law) { return c.of<decltype(law)>().rolling_arm > 0.0; });
  }

  /// Declares the motion of the coming interval from the present position of each surface.
  /// @pre one target for each surface, with all its vertices; duration > 0
  void set_targets(std::span<const SurfaceState> targets, double duration);
  /// Moves all surfaces to a share of the interval. @pre 0 ≤ share ≤ 1
  void move_to(double share);
  /// Searches for contacts only inside `grains`.
  void restrict_to(const SurfaceBox& grains);

  /// Bound on the speed of surfaces near the strip in this interval, m/s; 0 if none is near.
  double speed_near(const Strip& strip) const;
  /// Calls f(grain, surface, hit) for all points where grains of the strip touch surfaces now.
  template <class F>
  void each_hit(const Grains& grains, const Strip& strip, F&& f) const {
    std::array<SurfaceHit, kMaxSurfaceHits> hits;
    for (int g = strip.first; g < strip.last; ++g)
      for (int k = 0; k < count(); ++k) {
        const Quad& x = grains.position[g];
        if (!inside(surfaces_[k].near, x)) continue;
        const int found = surfaces_[k].collider.hits(Vec3(x.x, x.y, x.z), x.w, hits);
        for (int h = 0; h < found; ++h) f(g, k, hits[h]);
      }
  }
  Vec3 velocity_at(int k, const SurfaceHit& hit) const {
    FURROW_ASSERT(in_range(k, count()), k, count());
    return surfaces_[k].collider.velocity_at(hit);
  }

  /// Calls f(y_min, y_max), m, for each surface with vertices low enough to reach grains that now span some of these x,
  /// until one call returns true.
  template <class F>
  bool any_low_between(double x_min, double x_max, const F& f) const {
    return std::any_of(surfaces_.begin(), surfaces_.end(), [&](const Surface& s) {
      return s.low_min.x() < x_max && s.low_max.x() > x_min && f(s.low_min.y(), s.low_max.y());
    });
  }

  void resize(int strips) {
    FURROW_ASSERT(strips >= 0, strips);
    strips_.resize(strips);
  }
  /// Updates the indices of grains after a range of strips was sorted.
  void reorder(const Resorted& range, const Strips& strips);

  /// Call it before the parts of strip s are evaluated, in their order. One thread per strip calls it and these:
  void begin(int s, bool losses);
  /// Evaluates the contacts of the grains [from, to) of strip s, counted from its first. Adds to the loads (of the
  /// strip's grains, in order) and to `sums`; also to the losses in `sums` if they are wanted.
  void evaluate(const Grains& grains, const Strip& strip, int s, int from, int to, double dt, bool losses,
                const Loads& loads, ContactTotals& sums);
  /// Adds the energy stored in contacts that ended to `sums`, if losses are wanted.
  void end(const Grains& grains, int s, double dt, bool losses, ContactTotals& sums);

  /// Adds this substep's forces to the vertices, in the order of strips and grains. Returns the impulse on grains, N s.
  /// @param kick time for which the forces act, s  @param dt time by which the substep advances, s
  Vec3 add_substep_forces(double kick, double dt);
  /// Means over the interval. @pre one entry of forces and sums for each surface; duration > 0
  void finish(double duration, std::span<NodalForces> forces, std::span<ContactSums> sums);

  SurfaceBox swept_bounds(int k) const {
    FURROW_ASSERT(in_range(k, count()), k, count());
    return surfaces_[k].collider.swept_bounds();
  }

  void save(Archive& archive) const;
  /// Restores surfaces that are attached, or those in the archive. @pre `strips` are restored.
  void restore(const Archive& archive, const Strips& strips);

 private:
  struct Surface : TireSurface {
    using TireSurface::TireSurface;
    double fastest = 0.0;  // fastest vertex in this interval, m/s
    // Bounds in x, y of the vertices that may reach grains, m
    Eigen::Vector2d low_min = Eigen::Vector2d::Constant(-1e300), low_max = Eigen::Vector2d::Constant(1e300);
  };
  static bool inside(const SurfaceBox& box, const Quad& p) {
    return p.z > box.lo.z() && p.x > box.lo.x() && p.x < box.hi.x() && p.y > box.lo.y() && p.y < box.hi.y() &&
           p.z < box.hi.z();
  }
  bool near(const Surface& surface, const Strip& strip) const {
    const double slack = largest_;  // grains move less than this from where they were sorted
    return surface.near.lo.x() < strip.x_max + slack && surface.near.hi.x() > strip.x_min - slack;
  }
  template <class Law>
  void touch(const Grains& grains, SurfaceStrip& mine, int k, int g, double dt, bool losses, const Loads& load,
             ContactTotals& sums);
  /// Energy left in histories that no point has taken over, J.
  template <class Law>
  double abandoned(const Grains& grains, const SurfaceStrip& mine) const;

  GrainProperties grain_;
  double largest_;  // m
  LawKind law_;
  bool rolling_;
  bool tangents_ = false;
  double top_ = 1e300;  // height that no grain exceeds, m
  std::vector<Surface> surfaces_;
  std::vector<SurfaceStrip> strips_;
};

}  // namespace furrow::terrain::dem
