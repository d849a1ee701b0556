#include "terrain/dem/accounts/stored_energy.hpp"

#include <algorithm>
#include <cmath>

#include "protocol/core/assert.hpp"
#include "terrain/dem/close_pairs.hpp"

namespace furrow::terrain::dem {
namespace {

template <class Real>
bool take(const PairHistory<Real>& from, int p, ContactHistory<double>& to) {
  if (from.tangential.empty()) return false;
  const HistoryRow<Real>& t = from.tangential[p];
  to = {{t.x, t.y, t.z}, t.w, {0, 0, 0}};
  if (!from.rolling.empty()) to.rolling = {from.rolling[p].x, from.rolling[p].y, from.rolling[p].z};
  return true;
}

template <class Law>
Stored in_pairs(const Grains& grains, const Strips& strips, int k, const ContactCoefficients& all, double radius) {
  const Strip& strip = strips[k];
  const auto reference = all.of<Law>();
  const int n = strip.grains(), next = strips.next(k);
  const auto grain = [&](int place) { return place < n ? strip.first + place : strips[next].first + place - n; };
  Stored sum;
  for (int p = 0; p < strip.pairs; ++p) {
    if (!(strip.touching[p / kFloatLanes] >> p % kFloatLanes & 1)) continue;
    const Quad &a = grains.position[grain(strip.grain_i(p))], &b = grains.position[grain(strip.grain_j(p))];
    const Quad d = shortest(strips.options().bin, a, b);
    const double overlap = a.w + b.w - std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
    add(sum, Law::held(sized_pair<Law>(reference, radius, a.w, b.w), std::max(overlap, 0.0), pair_history(strip, p)),
        1.0);
  }
  return sum;
}

template <class Law>
Stored in_walls(const Grains& grains, const Strips& strips, const Strip& strip, const SolverCoefficients& all,
                double radius) {
  const auto floor = all.floor.of<Law>(), side = all.side.of<Law>();
  Stored sum;
  for (const WallContact& contact : strip.walls) {
    const Quad& x = grains.position[strip.first + contact.grain];
    const double overlap = x.w - strips.options().bin.distance(contact.wall, x);
    if (!(overlap > 0.0)) continue;
    const Quad &t = contact.tangential, &r = contact.rolling;
    add(sum,
        Law::held(sized_surface<Law>(contact.wall == kFloor ? floor : side, radius, x.w, 0.0), overlap,
                  {{t.x, t.y, t.z}, t.w, {r.x, r.y, r.z}}),
        1.0);
  }
  return sum;
}

}  // namespace

ContactHistory<double> pair_history(const Strip& strip, int p) {
  FURROW_ASSERT(in_range(p, strip.pairs), p, strip.pairs);
  ContactHistory<double> history{};
  if (!take(strip.single, p, history)) take(strip.full, p, history);
  return history;
}

std::vector<Stored> stored_energy(const Grains& grains, const Strips& strips, LawKind kind, const SolverCoefficients& c,
                                  double radius) {
  FURROW_ASSERT(radius > 0.0, radius);
  return with_law(kind, [&](auto law) {
    using Law = decltype(law);
    std::vector<Stored> out;
    for (int k = 0; k < strips.count(); ++k) {
      out.push_back(in_pairs<Law>(grains, strips, k, c.pair, radius));
      add(out.back(), in_walls<Law>(grains, strips, strips[k], c, radius), 1.0);
    }
    return out;
  });
}

}  // namespace furrow::terrain::dem
