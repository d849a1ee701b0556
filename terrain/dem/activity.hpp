// Decides which parcels are stepped, so that a bed at rest far from the tire costs nothing.
//
// A parcel (parcel.hpp; a narrow strip is one parcel) falls asleep after `kCalmSteps` calm steps. In a calm step its
// grains did not move, the net force on each stayed below a share of the mean contact force of the bed, and no tire was
// near. A step that is taken in parts (step_refinement.hpp) counts once, and was calm if all its parts were. Spin does
// not count, because a grain that spins in place loads no other grain.
//
// Grains do not move if they are slow, or if they drifted slowly over a window of `kSwayTime` and are not too fast now.
// The second rule is needed because a bed sways long after it has ceased to flow. A wheel sends out shear waves. At the
// lowest frequency of a layer of depth h, c_s/4h, they neither travel nor decay: damping acts on the relative speed of
// neighbours, which sway together. The drift of a grain is the mean of its velocity with weights that rise from 0 to
// the window's middle and fall to 0 again. Of a vibration of frequency f this mean keeps sinc²(f kSwayTime/2), of a
// flow all. A parcel woken by a push still counts as swaying until its next window ends; one woken by a tire or a
// moving grain does not.
//
// The grains of a sleeping parcel are not moved, and contacts among them keep their forces and histories. Contacts
// between it and awake parcels act on both. As long as a neighbour is awake, the net force on every sleeping grain is
// evaluated in every step. It contains all that has changed since the grain fell asleep. Above a limit the whole parcel
// wakes, before its grains have moved. A front of waking advances by one parcel per step, faster than any wave in the
// bed. A tire that comes near and a moving grain that comes in also wake it. The mean contact force is sampled every
// `kSampleSteps` steps; a sleeping parcel contributes its last sample, or its force when it fell asleep. Decisions use
// sums of fixed order, so they do not depend on threads.
//
// Pairs that touch belong to the same parcel or to neighbours. So loads on a parcel come from its own list and from
// those of the parcels before it: the previous one across, and three in the previous strip. A step treats a parcel in
// one of these ways, each of which includes the next:
//   loads     it is awake or touches an awake one: all lists with its grains are evaluated, its loads are complete
//   list      it lists grains of such a parcel
//   motion    a list of such a parcel contains its grains: their positions and motion are needed
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "protocol/core/assert.hpp"
#include "protocol/core/vec.hpp"
#include "terrain/dem/strips.hpp"

namespace furrow::terrain::dem {

// Speeds in units of √(g r), net forces in units of the mean contact force.
inline constexpr double kSleepMeanSpeed = 5e-3;  // root mean square over the parcel
inline constexpr double kSleepSpeed = 0.1;       // every grain
inline constexpr double kSwaySpeed = 0.2;        // every grain of a parcel that only sways
inline constexpr double kSleepForce = 0.05;
inline constexpr double kWakeForce = 0.1;
inline constexpr int kCalmSteps = 50;
inline constexpr double kSwayTime = 2.0;  // √(r/g)
inline constexpr int kDriftEvery = 8;     // steps between velocities that enter the drift
inline constexpr int kSampleSteps = 100;  // steps between samples of the mean contact force

class Activity {
 public:
  struct Limits {
    double mean_speed = 0.0;   // root mean square over the grains of a parcel that may sleep, m/s
    double speed = 0.0;        // of each grain, m/s
    double sway_speed = 0.0;   // of each grain of a parcel that only sways, m/s
    double sleep_force = 0.0;  // net force on each, N
    double wake_force = 0.0;   // net force on one grain that wakes its parcel, N
  };

  /// Motion of grains when they fell asleep.
  struct Stopped {
    double kinetic = 0.0;          // J
    Vec3 velocity = Vec3::Zero();  // Σ m v / m₀, m/s
  };

  /// What a step needs of a parcel, or of any parcel of a strip.
  enum Need : std::uint8_t { kMotion = 1, kList = 2, kLoads = 4 };

  void limit(const Limits& limits) {
    FURROW_ASSERT(limits.mean_speed >= 0.0 && limits.speed >= 0.0, limits.mean_speed, limits.speed);
    FURROW_ASSERT(!(limits.sleep_force > limits.wake_force), limits.sleep_force, limits.wake_force);
    limits_ = limits;
  }

  /// Decides what the coming step needs of each parcel, from those that are awake. Returns whether that may differ from
  /// the step before. @param sway_steps steps of a window
  bool plan(const Strips& strips, int sway_steps);
  /// Whether some list of strip k is evaluated.
  bool evaluated(int k) const { return any(k, kList); }
  /// Whether the loads on the grains of some parcel of strip k will be complete.
  bool complete(int k) const { return any(k, kLoads); }
  bool any(int k, Need what) const {
    FURROW_ASSERT(in_range(k, of_strip_.size()), k, of_strip_.size());
    return of_strip_[k] & what;
  }
  bool needs(int k, int parcel, Need what) const {
    FURROW_ASSERT(in_range(k, of_strip_.size()) && in_range(parcel, across_), k, parcel, across_);
    return need_[k * across_ + parcel] & what;
  }
  /// Calls f(from, to) for each row of neighbouring parcels [from, to) of strip k that need it. A row has several
  /// parcels only if `together(p)` holds for all of them.
  template <class Together, class F>
  void each_row(int k, Need what, const Together& together, const F& f) const {
    for (int p = 0; p < across_; ++p) {
      if (!needs(k, p, what)) continue;
      const int from = p;
      while (together(p) && p + 1 < across_ && needs(k, p + 1, what) && together(p + 1)) ++p;
      f(from, p + 1);
    }
  }
  template <class F>
  void each_row(int k, Need what, const F& f) const {
    each_row(
        k, what, [](int) { return true; }, f);
  }

  /// Whether the parcel falls asleep after the coming step if that step is calm.
  static bool about_to_sleep(const Parcel& parcel) { return !parcel.asleep && parcel.calm >= kCalmSteps - 1; }
  /// Adds the velocities of a parcel to the drift of its grains. @param drift, velocity of its first grain
  void add_drift(const Parcel& parcel, Drift* drift, const Quad* velocity) const;

  /// Puts calm parcels without a tire near them to sleep; wakes parcels that are pushed too hard or near a tire. Sets
  /// grains that fall asleep to rest and returns the motion that this removed.
  /// @param counts whether the step is over: a part of a step does not count towards the calm steps
  /// @param near(strip) whether a tire is near any part of the strip
  /// @param near_parcel(strip, p) whether it is near parcel p of such a strip
  template <class Near, class NearParcel>
  Stopped update(Strips& strips, Grains& grains, bool counts, const Near& near, const NearParcel& near_parcel) const {
    Stopped stopped;
    for (int k = 0; k < strips.count(); ++k) {
      Strip& strip = strips[k];
      if (strip.asleep && !woken(strip.motion) && !near(strip)) continue;
      bool changed = false;
      for (int p = 0; p < strips.across(); ++p) {
        Parcel& parcel = strip.parcels[p];
        const auto busy = [&] { return near(strip) && near_parcel(strip, p); };
        if (parcel.asleep) {
          const bool pushed = woken(parcel.motion);
          if (!pushed && !busy()) continue;
          changed = true;
          wake(parcel);
          parcel.sways = pushed;
        } else if (rests(strip, parcel, grains, counts)) {
          if (busy()) {
            parcel.calm = 0;
          } else {
            changed = true;
            stopped.kinetic += parcel.motion.kinetic;
            const Quad& v = parcel.motion.velocity;
            stopped.velocity += Vec3(v.x, v.y, v.z);
            put_to_sleep(strip, parcel, grains);
          }
        }
      }
      if (changed) strips.sleep_changed(k);
    }
    return stopped;
  }
  /// Returns whether it slept. It does not count as swaying until a window shows this.
  static bool wake(Parcel& parcel) {
    const bool slept = parcel.asleep;
    parcel.asleep = parcel.stale = false, parcel.sways = false, parcel.calm = parcel.window = 0;
    return slept;
  }
  /// Wakes the parcels of a sorted range into which a moving grain came.
  static void wake_moving(const Resorted& range, Strips& strips, const Grains& grains);

 private:
  /// Counts the step of an awake parcel. Returns whether it has been calm for long enough to sleep.
  bool rests(const Strip& strip, Parcel& parcel, const Grains& grains, bool counts) const;
  bool drifts_slowly(const Strip& strip, const Parcel& parcel, const Grains& grains) const;
  /// Weight of the velocity after that many steps of a window, in the drift.
  int weight(int step) const { return std::min(step, sway_steps_ - step); }
  bool woken(const MotionTotals& motion) const { return motion.max_net_force > limits_.wake_force; }
  static void put_to_sleep(const Strip& strip, Parcel& parcel, Grains& grains);
  /// For each parcel with the bit `from`, sets the bit `to` of the parcels at the offsets `beside` (strip, parcel).
  template <std::size_t kCount>
  void spread(const Strips& strips, Need from, Need to, const int (&beside)[kCount][2]);
  void mark(int k, int parcel, Need what) {
    need_[k * across_ + parcel] |= what;
    of_strip_[k] |= what;
  }

  Limits limits_;
  int sway_steps_ = std::numeric_limits<int>::max();
  int across_ = 1;
  std::int64_t planned_ = -1;           // Strips::changes() for which the needs below were decided
  std::vector<std::uint8_t> need_;      // per parcel, strip after strip
  std::vector<std::uint8_t> of_strip_;  // needs of any of its parcels
};

}  // namespace furrow::terrain::dem
