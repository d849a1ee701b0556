#include "terrain/dem/activity.hpp"

#include <algorithm>

#include "protocol/core/assert.hpp"

namespace furrow::terrain::dem {

template <std::size_t kCount>
void Activity::spread(const Strips& strips, Need from, Need to, const int (&beside)[kCount][2]) {
  for (int k = 0; k < strips.count(); ++k) {
    if (!any(k, from)) continue;
    for (int p = 0; p < across_; ++p) {
      if (!needs(k, p, from)) continue;
      for (const auto& [ahead, across] : beside) {
        const int strip = strips.beside(k, ahead), parcel = strips.parcel_beside(p, across);
        if (strip >= 0 && parcel >= 0) mark(strip, parcel, to);
      }
    }
  }
}

void Activity::plan(const Strips& strips) {
  // A list names grains of its own parcel, of the next one across, and of three in the next strip.
  static constexpr int kAround[9][2] = {{-1, -1}, {-1, 0}, {-1, 1}, {0, -1}, {0, 0}, {0, 1}, {1, -1}, {1, 0}, {1, 1}};
  static constexpr int kListedBy[5][2] = {{0, 0}, {0, -1}, {-1, -1}, {-1, 0}, {-1, 1}};
  static constexpr int kListed[5][2] = {{0, 0}, {0, 1}, {1, -1}, {1, 0}, {1, 1}};
  constexpr Need kAwake{8};
  if (planned_ == strips.changes()) return;
  planned_ = strips.changes();
  across_ = strips.across();
  need_.assign(static_cast<std::size_t>(strips.count()) * across_, 0);
  of_strip_.assign(strips.count(), 0);
  for (int k = 0; k < strips.count(); ++k) {
    const Strip& strip = strips[k];
    if (strip.asleep && !strip.stale) continue;
    for (int p = 0; p < across_; ++p) {
      if (!strip.parcels[p].asleep) mark(k, p, kAwake);
      if (strip.parcels[p].stale) mark(k, p, kLoads), planned_ = -1;  // only once
    }
  }
  spread(strips, kAwake, kLoads, kAround);
  spread(strips, kLoads, kList, kListedBy);
  spread(strips, kList, kMotion, kListed);
}

bool Activity::calm(const Parcel& parcel) const {
  const MotionTotals& m = parcel.motion;
  return m.speed2 <= limits_.mean_speed * limits_.mean_speed * parcel.part.grains() && m.max_speed < limits_.speed &&
         m.max_net_force < limits_.sleep_force;
}

void Activity::put_to_sleep(const Strip& strip, Parcel& parcel, Grains& grains) {
  FURROW_ASSERT(!parcel.asleep && strip.last <= grains.count, strip.last, grains.count);
  const auto stop = [&](std::vector<Quad>& motion) {
    const auto first = motion.begin() + strip.first;
    std::fill(first + parcel.part.first, first + parcel.part.last, Quad{});
  };
  stop(grains.velocity);
  stop(grains.spin);
  const MotionTotals before = parcel.motion;
  parcel.motion = {};
  parcel.motion.height = before.height;
  parcel.motion.held = before.held;
  parcel.asleep = true;
}

void Activity::wake_moving(const Resorted& range, Strips& strips, const Grains& grains) {
  FURROW_ASSERT(range.from >= 0 && range.to <= strips.count(), range.from, range.to, strips.count());
  const auto moves = [](const Quad& v) { return v.x != 0.0 || v.y != 0.0 || v.z != 0.0; };
  for (int k = range.from; k < range.to; ++k) {
    Strip& strip = strips[k];
    const auto first = grains.velocity.begin() + strip.first;
    bool changed = false;
    for (Parcel& parcel : strip.parcels)
      if (parcel.asleep && std::any_of(first + parcel.part.first, first + parcel.part.last, moves))
        changed |= wake(parcel);
    if (changed) strips.sleep_changed(k);
  }
}

}  // namespace furrow::terrain::dem
