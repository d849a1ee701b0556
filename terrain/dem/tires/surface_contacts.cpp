#include "terrain/dem/tires/surface_contacts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>
#include <tuple>

#include "protocol/core/archive_fields.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "terrain/dem/tires/surface_touch.hpp"

namespace furrow::terrain::dem {
namespace {

void add(Quad& q, const Triple<double>& t) { q.x += t.x, q.y += t.y, q.z += t.z; }

const SurfaceHistory* nearest(const std::vector<SurfaceHistory>& history, std::size_t from, std::size_t to,
                              const Vec3& n) {
  FURROW_ASSERT(from <= to && to <= history.size(), from, to, history.size());
  const SurfaceHistory* best = nullptr;
  double cosine = kSameNormal;
  for (std::size_t k = from; k < to; ++k) {
    const Quad& m = history[k].normal;
    const double c = m.x * n.x() + m.y * n.y() + m.z * n.z();
    if (c > cosine) cosine = c, best = &history[k];
  }
  return best;
}

ContactHistory<double> of(const SurfaceHistory& h) { return {triple(h.tangential), h.tangential.w, triple(h.rolling)}; }

}  // namespace

void SurfaceContacts::attach(const SurfaceMesh& mesh, const ContactMaterial& material,
                             const ContactCoefficients& coefficients, const SurfaceState& start) {
  FURROW_ASSERT(start.position.size() == static_cast<std::size_t>(mesh.vertex_count), start.position.size(),
                mesh.vertex_count);
  surfaces_.emplace_back(mesh, largest_, tangents_, grain_, material, start);
  set_coefficients(count() - 1, coefficients);
}

void SurfaceContacts::set_targets(std::span<const SurfaceState> targets, double duration) {
  FURROW_ASSERT(targets.size() == surfaces_.size(), targets.size(), surfaces_.size());
  FURROW_ASSERT(duration > 0.0, duration);
  for (std::size_t k = 0; k < surfaces_.size(); ++k)
    surfaces_[k].fastest = surfaces_[k].set_target(targets[k], duration) / duration;
}

void SurfaceContacts::move_to(double share) {
  FURROW_ASSERT(share >= 0.0 && share <= 1.0, share);
  for (Surface& s : surfaces_) {
    s.move_to(share, largest_);
    s.low_min.setConstant(1e300), s.low_max.setConstant(-1e300);
    for (const Vec3& x : s.collider.positions())
      if (x.z() < top_) {
        s.low_min = s.low_min.cwiseMin(x.head<2>());
        s.low_max = s.low_max.cwiseMax(x.head<2>());
      }
  }
}

double SurfaceContacts::speed_near(const Strip& strip) const {
  double fastest = 0.0;
  for (const Surface& s : surfaces_)
    if (near(s, strip)) fastest = std::max(fastest, s.fastest);
  return fastest;
}

void SurfaceContacts::restrict_to(const SurfaceBox& grains) {
  top_ = grains.hi.z();
  for (Surface& s : surfaces_) s.collider.restrict_to(grains);
}

void SurfaceContacts::reorder(const Resorted& range, const Strips& strips) {
  FURROW_ASSERT(range.from <= range.to && static_cast<std::size_t>(range.to) <= strips_.size(), range.from, range.to,
                strips_.size());
  std::vector<SurfaceHistory> all;
  for (int s = range.from; s < range.to; ++s) {
    all.insert(all.end(), strips_[s].history.begin(), strips_[s].history.end());
    strips_[s].history.clear();
    strips_[s].touches.clear();
  }
  if (all.empty()) return;
  std::vector<std::int32_t> new_of(range.order.size());
  for (std::size_t g = 0; g < range.order.size(); ++g)
    new_of[range.order[g] - range.first] = range.first + static_cast<std::int32_t>(g);
  for (SurfaceHistory& h : all) h.grain = new_of[h.grain - range.first];
  // Sorts indices, because the buffer of std::stable_sort is not aligned for a Quad.
  std::vector<std::int32_t> sorted(all.size());
  std::iota(sorted.begin(), sorted.end(), 0);
  std::sort(sorted.begin(), sorted.end(), [&](std::int32_t a, std::int32_t b) {
    return std::tie(all[a].grain, all[a].surface, a) < std::tie(all[b].grain, all[b].surface, b);
  });
  int s = range.from;
  for (const std::int32_t h : sorted) {
    while (all[h].grain >= strips[s].last) ++s;
    strips_[s].history.push_back(all[h]);
  }
}

template <class Law>
double SurfaceContacts::abandoned(const Grains& grains, const SurfaceStrip& mine) const {
  double held = 0.0;
  for (std::size_t k = 0; k < mine.history.size(); ++k) {
    const SurfaceHistory& h = mine.history[k];
    if (!mine.taken[k])
      held += Law::held(surfaces_[h.surface].against<Law>(grain_.radius, grains.position[h.grain].w), 0.0, of(h))
                  .tangential;
  }
  return held;
}

template <class Law>
void SurfaceContacts::touch(const Grains& grains, SurfaceStrip& mine, int k, int g, double dt, bool losses,
                            const Loads& load, ContactTotals& sums) {
  FURROW_ASSERT(in_range(k, count()) && in_range(g, grains.count), k, count(), g, grains.count);
  FURROW_ASSERT(load.force != nullptr && load.torque != nullptr, g);
  const Surface& surface = surfaces_[k];
  std::array<SurfaceHit, kMaxSurfaceHits> hits;
  const Quad& x = grains.position[g];
  const Vec3 centre(x.x, x.y, x.z);
  const int count = surface.collider.hits(centre, x.w, hits);
  if (count == 0) return;
  const auto c = surface.against<Law>(grain_.radius, x.w);
  const auto before = [](const SurfaceHistory& h, const std::pair<int, int>& key) {
    return std::pair<int, int>(h.grain, h.surface) < key;
  };
  const auto& old = mine.history;
  const auto from = std::lower_bound(old.begin(), old.end(), std::pair(g, k), before);
  const auto to = std::lower_bound(from, old.end(), std::pair(g, k + 1), before);

  const Triple<double> v = triple(grains.velocity[g]), w = triple(grains.spin[g]);
  for (int h = 0; h < count; ++h) {
    const SurfaceHit& hit = hits[h];
    const Triple<double> arm = triple(Vec3(hit.point - centre));
    const auto patch = surface.patch_at(hit, c.rolling_arm > 0.0);
    const ContactMotion<double> motion = motion_at(surface.collider, patch ? &*patch : nullptr, hit, arm, v, w);
    ContactHistory<double> history{{0, 0, 0}, 0.0, {0, 0, 0}};
    if (const SurfaceHistory* past = nearest(old, from - old.begin(), to - old.begin(), hit.normal)) {
      history = of(*past);
      if (losses) mine.taken[past - old.data()] = 1;
    }
    if (losses)
      add(sums.sample,
          rolling_ ? sample_of<Law, true>(c, dt, motion, history) : sample_of<Law, false>(c, dt, motion, history),
          hit.share);
    const ContactForce<double> f = rolling_ ? Law::template force<true>(c, dt, motion, history)
                                            : Law::template force<false>(c, dt, motion, history);
    const auto& t = history.tangential;
    const auto& r = history.rolling;
    const Quad normal{motion.normal.x, motion.normal.y, motion.normal.z, 0.0};
    if constexpr (Law::kHistory)
      mine.next.push_back({g, k, normal, {t.x, t.y, t.z, history.root_overlap}, {r.x, r.y, r.z, 0.0}});

    const auto [push, drag, torque] = facet_loads(f, motion.normal, arm, hit.share);
    add(*load.force, push + drag);
    add(*load.torque, torque);
    mine.touches.push_back({k, {hit.triangle, hit.weight, hit.point, -vec(push), -vec(drag), {}, {}, slides(c, f)}});
    if (patch) mine.touches.back().force.couple = patch->couple(-hit.share * vec(f.rolling));
    if (tangents_) mine.touches.back().force.tangent = contact_tangent<Law>(c, motion, f, hit.share);
    sums.power += hit.share * (power_of(f, motion) + dot(f.rolling, motion.roll));
    sums.elastic += hit.share * f.energy;
    sums.max_overlap = std::max(sums.max_overlap, hit.overlap);
    ++sums.contacts;
  }
}

void SurfaceContacts::begin(int s, bool losses) {
  FURROW_ASSERT(in_range(s, strips_.size()), s, strips_.size());
  SurfaceStrip& mine = strips_[s];
  mine.next.clear();
  mine.touches.clear();
  if (losses) mine.taken.assign(mine.history.size(), 0);
}

void SurfaceContacts::evaluate(const Grains& grains, const Strip& strip, int s, int from, int to, double dt,
                               bool losses, const Loads& loads, ContactTotals& sums) {
  FURROW_ASSERT(in_range(s, strips_.size()), s, strips_.size());
  FURROW_ASSERT(0 <= from && from <= to && to <= strip.grains(), from, to, strip.grains());
  SurfaceStrip& mine = strips_[s];
  const bool any_near =
      std::any_of(surfaces_.begin(), surfaces_.end(), [&](const Surface& surface) { return near(surface, strip); });
  if (!any_near) return;
  with_law(law_, [&](auto law) {
    for (int g = strip.first + from; g < strip.first + to; ++g)
      for (int k = 0; k < count(); ++k)
        if (inside(surfaces_[k].near, grains.position[g]))
          touch<decltype(law)>(grains, mine, k, g, dt, losses, loads.from(g - strip.first), sums);
  });
}

void SurfaceContacts::end(const Grains& grains, int s, double dt, bool losses, ContactTotals& sums) {
  FURROW_ASSERT(in_range(s, strips_.size()), s, strips_.size());
  SurfaceStrip& mine = strips_[s];
  if (losses)
    sums.sample.power.opening += with_law(law_, [&](auto law) { return abandoned<decltype(law)>(grains, mine); }) / dt;
  mine.history.swap(mine.next);
}

Vec3 SurfaceContacts::add_substep_forces(double kick, double dt) {
  FURROW_ASSERT(kick > 0.0 && dt > 0.0, kick, dt);
  Vec3 on_grains = Vec3::Zero();
  for (Surface& s : surfaces_) s.forces.clear();
  for (const SurfaceStrip& strip : strips_)
    for (const SurfaceTouch& touch : strip.touches) {
      FURROW_ASSERT(in_range(touch.surface, surfaces_.size()), touch.surface, surfaces_.size());
      surfaces_[touch.surface].forces.push_back(touch.force);
      on_grains -= kick * (touch.force.normal + touch.force.tangential);
    }
  for (Surface& s : surfaces_) s.sum.add_substep(s.forces, s.collider, kick, dt);
  return on_grains;
}

void SurfaceContacts::finish(double duration, std::span<NodalForces> forces, std::span<ContactSums> sums) {
  FURROW_ASSERT(forces.size() == surfaces_.size(), forces.size(), surfaces_.size());
  FURROW_ASSERT(sums.size() == surfaces_.size(), sums.size(), surfaces_.size());
  FURROW_ASSERT(duration > 0.0, duration);
  for (std::size_t k = 0; k < surfaces_.size(); ++k) surfaces_[k].sum.finish(duration, forces[k], sums[k]);
}

// ---- state ----------------------------------------------------------------------------------------------------

void SurfaceContacts::save(Archive& archive) const {
  save_surfaces(archive, "surface", surfaces_);
  ColumnWriter<SurfaceHistory> history;
  for (const SurfaceStrip& strip : strips_)
    for (const SurfaceHistory& one : strip.history) history.add(one);
  history.put(archive, "surfaces/history");
}

void SurfaceContacts::restore(const Archive& archive, const Strips& strips) {
  FURROW_ASSERT(static_cast<int>(strips_.size()) == strips.count(), strips_.size(), strips.count());
  restore_surfaces(archive, "surface", surfaces_, [&](const auto& mesh, const auto& material, const auto& start) {
    attach(mesh, material, {}, start);
  });
  for (SurfaceStrip& strip : strips_) strip = {};
  std::vector<SurfaceHistory> history;
  restore_value(archive, "surfaces/history", history);
  int s = 0;
  for (const SurfaceHistory& one : history) {
    while (s < strips.count() && one.grain >= strips[s].last) ++s;
    if (s == strips.count() || one.grain < strips[s].first || one.surface < 0 || one.surface >= count())
      throw Error(ExitCode::io,
                  "saved state 'surfaces/history' names a grain or a surface that there is not, or not in "
                  "their order: it is damaged");
    strips_[s].history.push_back(one);
  }
}

}  // namespace furrow::terrain::dem
