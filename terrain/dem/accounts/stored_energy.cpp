#include "terrain/dem/accounts/stored_energy.hpp"

#include <algorithm>
#include <cmath>

#include "protocol/core/assert.hpp"
#include "terrain/dem/close_pairs.hpp"
#include "terrain/dem/size_scale.hpp"

namespace furrow::terrain::dem {
namespace {

template <class Real>
Triple<double> wide(const HistoryRow<Real>& h) {
  return {h.x, h.y, h.z};
}

template <class Real>
double held_by(const ContactCoefficients& c, const PairHistory<Real>& history, int p) {
  if (history.tangential.empty()) return 0.0;
  const Triple<double> rolling = history.rolling.empty() ? Triple<double>{} : wide(history.rolling[p]);
  return held_by_springs(c, wide(history.tangential[p]), history.tangential[p].w, rolling);
}

Stored in_pairs(const Grains& grains, const Strips& strips, int k, const ContactCoefficients& reference,
                double radius) {
  const Strip& strip = strips[k];
  const int n = strip.grains(), next = strips.next(k);
  const auto grain = [&](int place) { return place < n ? strip.first + place : strips[next].first + place - n; };
  Stored sum;
  for (int p = 0; p < strip.pairs; ++p) {
    if (!(strip.touching[p / kFloatLanes] >> p % kFloatLanes & 1)) continue;
    const Quad &a = grains.position[grain(strip.grain_i(p))], &b = grains.position[grain(strip.grain_j(p))];
    const ContactCoefficients c = pair_coefficients(reference, radius, a.w, b.w);
    const Quad d = shortest(strips.options().bin, a, b);
    const double overlap = a.w + b.w - std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
    sum.cohesion -= c.cohesion_force * std::max(overlap, 0.0);
    sum.tangential += held_by_pair(c, strip, p);
  }
  return sum;
}

Stored in_walls(const Grains& grains, const Strips& strips, const Strip& strip, const SolverCoefficients& all,
                double radius) {
  Stored sum;
  for (const WallContact& contact : strip.walls) {
    const Quad& x = grains.position[strip.first + contact.grain];
    const double overlap = x.w - strips.options().bin.distance(contact.wall, x);
    if (!(overlap > 0.0)) continue;
    ContactCoefficients c = contact.wall == kFloor ? all.floor : all.side;
    if (x.w != radius) c = scaled(c, surface_scale(x.w / radius, 0.0));
    const Quad &t = contact.tangential, &r = contact.rolling;
    sum.cohesion -= c.cohesion_force * overlap;
    sum.tangential += held_by_springs(c, {t.x, t.y, t.z}, t.w, {r.x, r.y, r.z});
  }
  return sum;
}

}  // namespace

double held_by_pair(const ContactCoefficients& c, const Strip& strip, int p) {
  FURROW_ASSERT(in_range(p, strip.pairs), p, strip.pairs);
  return held_by(c, strip.single, p) + held_by(c, strip.full, p);
}

std::vector<Stored> stored_energy(const Grains& grains, const Strips& strips, const SolverCoefficients& c,
                                  double radius) {
  FURROW_ASSERT(radius > 0.0, radius);
  std::vector<Stored> out;
  for (int k = 0; k < strips.count(); ++k) {
    out.push_back(in_pairs(grains, strips, k, c.pair, radius));
    add(out.back(), in_walls(grains, strips, strips[k], c, radius), 1.0);
  }
  return out;
}

}  // namespace furrow::terrain::dem
