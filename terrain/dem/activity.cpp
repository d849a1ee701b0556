#include "terrain/dem/activity.hpp"

#include <algorithm>

#include "protocol/core/assert.hpp"

namespace furrow::terrain::dem {

void Activity::plan(const Strips& strips) {
  const int n = strips.count();
  const bool ring = strips.options().bin.periodic_x;
  const auto at = [&](int k) { return ring ? (k + n) % n : k; };
  const auto inside = [&](int k) { return ring || (k >= 0 && k < n); };
  need_.assign(n, 0);
  for (int k = 0; k < n; ++k) {
    if (strips[k].asleep) continue;
    for (int near = k - 1; near <= k + 1; ++near)
      if (inside(near)) need_[at(near)] |= kLoads;
  }
  for (int k = 0; k < n; ++k) {
    if (!(need_[k] & kLoads)) continue;
    need_[k] |= kList;
    if (inside(k - 1)) need_[at(k - 1)] |= kList;
  }
}

bool Activity::calm(const Strip& strip) const {
  const MotionTotals& m = strip.motion;
  return m.speed2 <= limits_.mean_speed * limits_.mean_speed * strip.grains() &&
         m.max_speed < limits_.speed && m.max_net_force < limits_.sleep_force;
}

void Activity::put_to_sleep(Strip& strip, Grains& grains) {
  FURROW_ASSERT(!strip.asleep && strip.last <= grains.count, strip.last, grains.count);
  std::fill(grains.velocity.begin() + strip.first, grains.velocity.begin() + strip.last, Quad{});
  std::fill(grains.spin.begin() + strip.first, grains.spin.begin() + strip.last, Quad{});
  const MotionTotals before = strip.motion;
  strip.motion = {};
  strip.motion.height = before.height;
  strip.motion.held = before.held;
  strip.asleep = true;
}

void Activity::wake_moving(const Resorted& range, Strips& strips, const Grains& grains) {
  FURROW_ASSERT(range.from >= 0 && range.to <= strips.count(), range.from, range.to, strips.count());
  const auto moves = [](const Quad& v) { return v.x != 0.0 || v.y != 0.0 || v.z != 0.0; };
  for (int k = range.from; k < range.to; ++k) {
    Strip& strip = strips[k];
    if (strip.asleep &&
        std::any_of(grains.velocity.begin() + strip.first, grains.velocity.begin() + strip.last, moves))
      strip.asleep = false, strip.calm = 0;
  }
}

}  // namespace furrow::terrain::dem
