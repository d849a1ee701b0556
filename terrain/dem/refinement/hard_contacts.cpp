#include "terrain/dem/refinement/hard_contacts.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "protocol/core/assert.hpp"
#include "terrain/dem/close_pairs.hpp"
#include "terrain/surface/surface_vectors.hpp"

namespace furrow::terrain::dem {
namespace {

using terrain::vec;
Vec3 vec(const Quad& q) { return {q.x, q.y, q.z}; }

/// Collects the hardest contacts, in the order in which contacts are visited.
class Search {
 public:
  Search(const GrainSolver& solver, double above, double ahead)
      : grains_(solver.grains()), strips_(solver.strips()), bin_(solver.params().bin), above_(above), ahead_(ahead) {}

  void pairs(int k) {
    const Strip& strip = strips_[k];
    const int n = strip.grains(), next = strips_.next(k);
    const auto grain = [&](int place) { return place < n ? strip.first + place : strips_[next].first + place - n; };
    for (int p = 0; p < strip.pairs; ++p) {
      const int i = grain(strip.grain_i(p)), j = grain(strip.grain_j(p));
      const Quad &a = grains_.position[i], &b = grains_.position[j];
      const Quad d = shortest(bin_, b, a);  // from j to i
      const double distance2 = d.x * d.x + d.y * d.y + d.z * d.z, far = a.w + b.w - above_;
      if (distance2 >= far * far) continue;
      const double distance = std::sqrt(distance2);
      const Vec3 normal = distance > 0.0 ? Vec3(vec(d) / distance) : Vec3(Vec3::UnitZ());
      const Vec3 velocity = vec(grains_.velocity[i]) - vec(grains_.velocity[j]);
      add(a.w + b.w - distance, velocity.dot(normal), std::min(a.w, b.w), i, [] { return std::string("two grains"); });
    }
  }

  void walls(int k) {
    const Strip& strip = strips_[k];
    for (const WallContact& contact : strip.walls) {
      const int g = strip.first + contact.grain;
      const Quad& x = grains_.position[g];
      const double overlap = x.w - bin_.distance(contact.wall, x);
      if (overlap > above_)
        add(overlap, vec(grains_.velocity[g]).dot(vec(Bin::normal(contact.wall))), x.w, g,
            [&] { return std::string("a grain and ") + Bin::name(contact.wall); });
    }
  }

  void surfaces(const SurfaceContacts& surfaces, int k) {
    surfaces.each_hit(grains_, strips_[k], [&](int g, int surface, const SurfaceHit& hit) {
      if (!(hit.overlap > above_)) return;
      const Vec3 velocity = vec(grains_.velocity[g]) - surfaces.velocity_at(surface, hit);
      add(hit.overlap, velocity.dot(hit.normal), grains_.position[g].w, g,
          [&] { return fmt::format("a grain and tire {}", surface); });
    });
  }

  const HardContacts& found() const { return found_; }

 private:
  /// @param parting speed of separation along the normal, m/s
  template <class Between>
  void add(double overlap, double parting, double radius, int grain, const Between& between) {
    FURROW_ASSERT(radius > 0.0 && in_range(grain, grains_.count), radius, grain);
    const double share = 0.5 * overlap / radius;
    ++found_.count;
    found_.past += share > kDeepestShare ? 1 : 0;
    found_.overlap = std::max(found_.overlap, overlap);
    found_.coming = std::max(found_.coming, overlap + ahead_ * std::max(0.0, -parting));
    if (share <= found_.share) return;
    found_.share = share;
    found_.deepest = overlap;
    found_.at = vec(grains_.position[grain]);
    found_.between = between();
  }

  const Grains& grains_;
  const Strips& strips_;
  const Bin& bin_;
  double above_, ahead_;
  HardContacts found_;
};

}  // namespace

HardContacts hard_contacts(const GrainSolver& solver, double above, double ahead) {
  FURROW_ASSERT(above > 0.0 && ahead >= 0.0, above, ahead);
  Search search(solver, above, ahead);
  for (int k = 0; k < solver.strips().count(); ++k) {
    if (!solver.may_overlap(k, above)) continue;
    search.pairs(k);
    search.walls(k);
    if (solver.surfaces().any()) search.surfaces(solver.surfaces(), k);
  }
  return search.found();
}

}  // namespace furrow::terrain::dem
