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

bool Activity::plan(const Strips& strips, int sway_steps) {
  // A list contains grains of its own parcel, of the next one across, and of three in the next strip.
  static constexpr int kAround[9][2] = {{-1, -1}, {-1, 0}, {-1, 1}, {0, -1}, {0, 0}, {0, 1}, {1, -1}, {1, 0}, {1, 1}};
  static constexpr int kListedBy[5][2] = {{0, 0}, {0, -1}, {-1, -1}, {-1, 0}, {-1, 1}};
  static constexpr int kListed[5][2] = {{0, 0}, {0, 1}, {1, -1}, {1, 0}, {1, 1}};
  constexpr Need kAwake{8};
  sway_steps_ = sway_steps;
  if (planned_ == strips.changes()) return false;
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
  return true;
}

void Activity::add_drift(const Parcel& parcel, Drift* drift, const Quad* velocity) const {
  const int step = parcel.window;
  if (step % kDriftEvery != kDriftEvery / 2) return;
  const auto w = static_cast<float>(weight(step));
  const bool first = step < kDriftEvery;
  for (int g = 0; g < parcel.part.grains(); ++g) {
    const Quad& v = velocity[g];
    const Drift before = first ? Drift{} : drift[g];
    drift[g] = {before.x + w * static_cast<float>(v.x), before.y + w * static_cast<float>(v.y),
                before.z + w * static_cast<float>(v.z)};
  }
}

bool Activity::drifts_slowly(const Strip& strip, const Parcel& parcel, const Grains& grains) const {
  double weights = 0.0, sum2 = 0.0, most2 = 0.0;
  for (int step = kDriftEvery / 2; step < sway_steps_; step += kDriftEvery) weights += weight(step);
  const auto first = grains.drift.begin() + strip.first;
  for (auto d = first + parcel.part.first; d != first + parcel.part.last; ++d) {
    const double drift2 =
        static_cast<double>(d->x) * d->x + static_cast<double>(d->y) * d->y + static_cast<double>(d->z) * d->z;
    sum2 += drift2;
    most2 = std::max(most2, drift2);
  }
  const double mean = weights * limits_.mean_speed, most = weights * limits_.speed;
  return sum2 <= mean * mean * parcel.part.grains() && most2 < most * most;
}

bool Activity::rests(const Strip& strip, Parcel& parcel, const Grains& grains, bool counts) const {
  const MotionTotals& m = parcel.motion;
  parcel.window += counts ? 1 : 0;
  if (parcel.window >= sway_steps_) {
    parcel.sways = drifts_slowly(strip, parcel, grains);
    parcel.window = 0;
  }
  const bool slow = m.speed2 <= limits_.mean_speed * limits_.mean_speed * parcel.part.grains();
  const bool moves = parcel.sways ? !(m.max_speed < limits_.sway_speed) : !(slow && m.max_speed < limits_.speed);
  if (moves || !(m.max_net_force < limits_.sleep_force)) {
    parcel.calm = 0;
  } else {
    parcel.calm += counts ? 1 : 0;
  }
  return parcel.calm >= kCalmSteps;
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
  parcel.asleep = parcel.sways = true;
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
