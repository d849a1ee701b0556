// Which strips are stepped: far from the tire a bed at rest costs nothing.
//
// A strip sleeps when for `kCalmSteps` steps its grains were slow, the net force on each stayed below a share of the
// mean contact force of the bed, and no tire was near. A step that is taken in parts (step_refinement.hpp) counts once,
// and was calm if all its parts were. Spin does not count: a grain that only spins in its place loads
// nobody. Its grains then stand still: they are not moved, contacts among them keep their forces and histories. The
// strips beside it that are awake still feel it, with all contacts across, and it feels them: as long as a neighbour
// is awake the net force on every sleeping grain is evaluated in every step, and since the grain stands still that
// holds all that changed since it fell asleep. Above a limit the whole strip wakes, before its grains have moved at
// all; a front of waking runs one strip per step, faster than any wave in the bed. A tire that comes near and a
// moving grain that comes in wake it too. The mean contact force is sampled every `kSampleSteps` steps; a strip that
// sleeps counts as when it was last evaluated at such a step. Decisions use sums of fixed order: they do not depend on
// threads.
#pragma once

#include <cstdint>
#include <vector>

#include "protocol/core/assert.hpp"
#include "protocol/core/vec.hpp"
#include "terrain/dem/strips.hpp"

namespace furrow::terrain::dem {

// Speeds in units of √(g r), net forces in units of the mean contact force.
inline constexpr double kSleepMeanSpeed = 5e-3;  // root mean square over the strip
inline constexpr double kSleepSpeed = 0.1;       // every grain
inline constexpr double kSleepForce = 0.05;
inline constexpr double kWakeForce = 0.1;
inline constexpr int kCalmSteps = 50;
inline constexpr int kSampleSteps = 100;  // between samples of the mean contact force

class Activity {
 public:
  struct Limits {
    double mean_speed = 0.0;   // of grains that may sleep, m/s
    double speed = 0.0;        // of each, m/s
    double sleep_force = 0.0;  // net force on each, N
    double wake_force = 0.0;   // net force on one grain that wakes its strip, N
  };

  /// Of grains when they fell asleep.
  struct Stopped {
    double kinetic = 0.0;          // J
    Vec3 velocity = Vec3::Zero();  // Σ m v / m₀, m/s
  };

  void limit(const Limits& limits) {
    FURROW_ASSERT(limits.mean_speed >= 0.0 && limits.speed >= 0.0, limits.mean_speed, limits.speed);
    FURROW_ASSERT(!(limits.sleep_force > limits.wake_force), limits.sleep_force, limits.wake_force);
    limits_ = limits;
  }

  /// Decides from who is awake which strips are evaluated in the coming step.
  void plan(const Strips& strips);
  /// The list of strip k is evaluated: some grain named in it needs its net force.
  bool evaluated(int k) const {
    FURROW_ASSERT(in_range(k, need_.size()), k, need_.size());
    return need_[k] & kList;
  }
  /// The loads on the grains of strip k will be complete: it is awake, or sleeps beside one that is.
  bool complete(int k) const {
    FURROW_ASSERT(in_range(k, need_.size()), k, need_.size());
    return need_[k] & kLoads;
  }

  /// Calm strips where `busy(k)` is false fall asleep, strips pushed too hard or busy wake.
  /// Sets what stops moving to rest and returns the motion that this took away.
  /// @param counts the step is over, rather than a part of it: it counts for strips that were calm
  template <class Busy>
  Stopped update(Strips& strips, Grains& grains, bool counts, const Busy& busy) const {
    Stopped stopped;
    for (int k = 0; k < strips.count(); ++k) {
      Strip& strip = strips[k];
      if (strip.asleep ? woken(strip) : !calm(strip)) {
        strip.asleep = false, strip.calm = 0;
      } else if (strip.asleep || (strip.calm += counts ? 1 : 0) >= kCalmSteps) {
        if (busy(strip)) {
          strip.asleep = false, strip.calm = 0;
        } else if (!strip.asleep) {
          stopped.kinetic += strip.motion.kinetic;
          stopped.velocity += Vec3(strip.motion.velocity.x, strip.motion.velocity.y, strip.motion.velocity.z);
          put_to_sleep(strip, grains);
        }
      }
    }
    return stopped;
  }
  /// Wakes the strips of a sorted range into which a moving grain came.
  static void wake_moving(const Resorted& range, Strips& strips, const Grains& grains);

 private:
  static constexpr std::uint8_t kList = 1, kLoads = 2;
  bool calm(const Strip& strip) const;
  bool woken(const Strip& strip) const { return strip.motion.max_net_force > limits_.wake_force; }
  static void put_to_sleep(Strip& strip, Grains& grains);

  Limits limits_;
  std::vector<std::uint8_t> need_;  // per strip
};

}  // namespace furrow::terrain::dem
