// Which parcels are stepped: far from the tire a bed at rest costs nothing.
//
// A parcel (parcel.hpp; a narrow strip is one) sleeps when for `kCalmSteps` steps its grains did not move, the net
// force on each stayed below a share of the mean contact force of the bed, and no tire was near. A step that is taken
// in parts (step_refinement.hpp) counts once, and was calm if all its parts were. Spin does not count: a grain that
// only spins in its place loads nobody.
//
// Grains do not move when they are slow, or when they went nowhere over a window of `kSwayTime` and are not too fast
// now. The second counts because a bed sways long after it ceased to flow: a wheel sends out shear waves, and at the
// lowest frequency of a layer of depth h, c_s/4h, these neither travel nor decay, as damping acts on the relative speed
// of neighbours, which sway together. A grain went nowhere when its drift was slow: the mean of its velocity with
// weights that rise from 0 to the window's middle and fall to 0 again. Of a vibration of frequency f that mean keeps
// sinc²(f kSwayTime/2), of a flow all. What a push wakes is still known to have gone nowhere until its next window
// ends; what a tire or a moving grain wakes is not.
//
// The grains of a sleeping parcel stand still: they are not moved, contacts among them keep their forces and histories.
// The parcels around it that are awake still feel it, with all contacts across, and it feels them: as long as a
// neighbour is awake the net force on every sleeping grain is evaluated in every step, and since the grain stands still
// that holds all that changed since it fell asleep. Above a limit the whole parcel wakes, before its grains have moved
// at all; a front of waking runs one parcel per step, faster than any wave in the bed. A tire that comes near and a
// moving grain that comes in wake it too. The mean contact force is sampled every `kSampleSteps` steps; what sleeps
// counts as when it was last evaluated at such a step, or as it fell asleep. Decisions use sums of fixed order: they do
// not depend on threads.
//
// Pairs that touch belong to parcels beside each other, so that loads on a parcel come from its own list and those of
// the parcels before it: the one across, and three in the strip before. What a step does with a parcel is one of
//   loads     it is awake, or feels one that is: all lists with its grains are evaluated, its loads are complete
//   list      it lists grains of such a parcel
//   motion    grains of it are listed by one of those: where they are and how they move is needed
// each of which implies the next.
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
inline constexpr int kDriftEvery = 8;     // steps from one velocity that the drift takes in to the next
inline constexpr int kSampleSteps = 100;  // between samples of the mean contact force

class Activity {
 public:
  struct Limits {
    double mean_speed = 0.0;   // of grains that may sleep, m/s
    double speed = 0.0;        // of each, m/s
    double sway_speed = 0.0;   // of each while they only sway, m/s
    double sleep_force = 0.0;  // net force on each, N
    double wake_force = 0.0;   // net force on one grain that wakes its parcel, N
  };

  /// Of grains when they fell asleep.
  struct Stopped {
    double kinetic = 0.0;          // J
    Vec3 velocity = Vec3::Zero();  // Σ m v / m₀, m/s
  };

  /// What a step does with a parcel, or with some of a strip.
  enum Need : std::uint8_t { kMotion = 1, kList = 2, kLoads = 4 };

  void limit(const Limits& limits) {
    FURROW_ASSERT(limits.mean_speed >= 0.0 && limits.speed >= 0.0, limits.mean_speed, limits.speed);
    FURROW_ASSERT(!(limits.sleep_force > limits.wake_force), limits.sleep_force, limits.wake_force);
    limits_ = limits;
  }

  /// Decides from who is awake what the coming step does with which parcels. @param sway_steps of a window
  void plan(const Strips& strips, int sway_steps);
  /// Some list of strip k is evaluated.
  bool evaluated(int k) const { return any(k, kList); }
  /// The loads on the grains of some parcel of strip k will be complete.
  bool complete(int k) const { return any(k, kLoads); }
  bool any(int k, Need what) const {
    FURROW_ASSERT(in_range(k, of_strip_.size()), k, of_strip_.size());
    return of_strip_[k] & what;
  }
  bool needs(int k, int parcel, Need what) const {
    FURROW_ASSERT(in_range(k, of_strip_.size()) && in_range(parcel, across_), k, parcel, across_);
    return need_[k * across_ + parcel] & what;
  }
  /// Calls f(from, to) for each row of neighbouring parcels [from, to) of strip k that need it, as long as
  /// `together(p)` holds for all of them; the others are rows of one.
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

  /// It falls asleep after the coming step, if that is calm.
  static bool about_to_sleep(const Parcel& parcel) { return !parcel.asleep && parcel.calm >= kCalmSteps - 1; }
  /// Takes the velocities of a parcel into the drift of its grains. @param drift, velocity of its first grain
  void add_drift(const Parcel& parcel, Drift* drift, const Quad* velocity) const;

  /// Calm parcels without a tire near fall asleep, those pushed too hard or near a tire wake.
  /// Sets what stops moving to rest and returns the motion that this took away.
  /// @param counts the step is over, rather than a part of it: it counts for parcels that were calm
  /// @param near(strip) a tire is near some of it  @param near_parcel(strip, p) it is near parcel p of a strip that it
  /// is near
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
  /// Returns whether it slept. It moves until the opposite is known.
  static bool wake(Parcel& parcel) {
    const bool slept = parcel.asleep;
    parcel.asleep = parcel.stale = false, parcel.sways = false, parcel.calm = parcel.window = 0;
    return slept;
  }
  /// Wakes the parcels of a sorted range into which a moving grain came.
  static void wake_moving(const Resorted& range, Strips& strips, const Grains& grains);

 private:
  /// Counts the step of an awake parcel. Returns whether it was calm for long enough to sleep.
  bool rests(const Strip& strip, Parcel& parcel, const Grains& grains, bool counts) const;
  bool drifts_slowly(const Strip& strip, const Parcel& parcel, const Grains& grains) const;
  /// Of the velocity after that many steps of a window, in its mean.
  int weight(int step) const { return std::min(step, sway_steps_ - step); }
  bool woken(const MotionTotals& motion) const { return motion.max_net_force > limits_.wake_force; }
  static void put_to_sleep(const Strip& strip, Parcel& parcel, Grains& grains);
  /// Marks for each parcel that has the bit `from` those that `beside` names by strip and parcel with the bit `to`.
  template <std::size_t kCount>
  void spread(const Strips& strips, Need from, Need to, const int (&beside)[kCount][2]);
  void mark(int k, int parcel, Need what) {
    need_[k * across_ + parcel] |= what;
    of_strip_[k] |= what;
  }

  Limits limits_;
  int sway_steps_ = std::numeric_limits<int>::max();
  int across_ = 1;
  std::int64_t planned_ = -1;           // Strips::changes() for which what follows was decided
  std::vector<std::uint8_t> need_;      // per parcel, those of a strip one after another
  std::vector<std::uint8_t> of_strip_;  // what any of its parcels needs
};

}  // namespace furrow::terrain::dem
