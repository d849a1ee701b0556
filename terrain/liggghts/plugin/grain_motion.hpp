// Motion of a rank's grains in one step (engine.hpp), and the sums over them if they are wanted. Grains of one size are
// moved four at a time: their vectors are contiguous, twelve numbers in three registers.
#pragma once

#include <array>
#include <cmath>
#include <limits>

#include "protocol/core/assert.hpp"
#include "protocol/core/simd.hpp"
#include "terrain/liggghts/engine.hpp"

namespace furrow::terrain::liggghts {

struct MovingGrains {
  double (*position)[3] = nullptr;      // m
  double (*velocity)[3] = nullptr;      // m/s
  double (*spin)[3] = nullptr;          // rad/s
  const double (*force)[3] = nullptr;   // N
  const double (*torque)[3] = nullptr;  // N m
  const double* radius = nullptr;       // m
};

class GrainMotion {
 public:
  GrainMotion(const EngineSetup& setup, const StepTimes& times)
      : times_(times),
        gravity_(setup.gravity),
        mass_(setup.grain.mass),
        inertia_(setup.grain.inertia),
        radius_(setup.grain.radius) {
    FURROW_ASSERT(mass_ > 0.0 && inertia_ > 0.0 && radius_ > 0.0, mass_, inertia_, radius_);
    for (int k = 0; k < 3 * kLanes; ++k) falls_[k / kLanes][k % kLanes] = gravity_[k % 3];
  }

  /// @tparam kSums  adds them to sums()  @tparam kSizes  radii differ
  template <bool kSums, bool kSizes>
  void move(const MovingGrains& grains, int count) {
    FURROW_ASSERT(count >= 0, count);
    int g = 0;
    if constexpr (!kSizes) {
      const Four four{times_.kick, times_.dt, 1.0 / mass_, 1.0 / inertia_, falls_};
      Lanes lanes = lanes_;  // a copy, because stores to the grains might alias it
      for (; g + kLanes <= count; g += kLanes) four.move<kSums>(grains, g, lanes);
      lanes_ = lanes;
      if constexpr (kSums) sums_.volume += g;
    }
    for (; g < count; ++g) move_one<kSums, kSizes>(grains, g);
  }

  /// Fastest of all grains that were moved, m/s; infinite if one is not a number.
  double fastest() const {
    double most2 = fastest2_;
    for (int k = 0; k < kLanes; ++k)
      if (lanes_.fastest2[k] > most2) most2 = lanes_.fastest2[k];
    return std::sqrt(most2);
  }

  MotionSums sums() const {
    MotionSums all = sums_;
    for (int k = 0; k < 3 * kLanes; ++k) {
      const int part = k / kLanes, lane = k % kLanes;
      all.speed[k % 3] += lanes_.speed[part][lane];
      all.place[k % 3] += lanes_.place[part][lane];
      all.speed2 += lanes_.speed2[part][lane];
      all.spin2 += lanes_.spin2[part][lane];
    }
    return all;
  }

 private:
  using Double4 = simd::Double4;
  using Twelve = std::array<Double4, 3>;  // x0 y0 z0 x1 | y1 z1 x2 y2 | z2 x3 y3 z3
  static constexpr int kLanes = simd::kDoubleLanes;
  static constexpr double kForever = std::numeric_limits<double>::infinity();

  struct Lanes {
    Double4 fastest2{};  // m²/s²
    Twelve speed{}, place{}, speed2{}, spin2{};
  };

  /// Moves four grains.
  struct Four {
    double kick, dt, per_mass, per_inertia;  // s, s, 1/kg, 1/(kg m²)
    Twelve gravity;                          // m/s²

    template <bool kSums>
    void move(const MovingGrains& grains, int g, Lanes& lanes) const {
      double *const x = grains.position[g], *const v = grains.velocity[g], *const w = grains.spin[g];
      const double *const f = grains.force[g], *const t = grains.torque[g];
      Twelve speed;
      for (int k = 0; k < 3; ++k) {
        const int at = kLanes * k;
        const Double4 a = simd::load(f + at) * per_mass + gravity[k], alpha = simd::load(t + at) * per_inertia;
        const Double4 spin = simd::load(w + at) + kick * alpha;
        speed[k] = simd::load(v + at) + kick * a;
        const Double4 place = simd::load(x + at) + dt * speed[k];
        simd::store(w + at, spin);
        simd::store(v + at, speed[k]);
        simd::store(x + at, place);
        if constexpr (kSums) {
          lanes.speed[k] += speed[k];
          lanes.place[k] += place;
          lanes.speed2[k] += speed[k] * speed[k];
          lanes.spin2[k] += spin * spin;
        }
      }
      const auto& [p, q, r] = speed;
      const Double4 vx = __builtin_shufflevector(__builtin_shufflevector(p, q, 0, 3, 6, 6), r, 0, 1, 2, 5);
      const Double4 vy = __builtin_shufflevector(__builtin_shufflevector(p, q, 1, 4, 7, 7), r, 0, 1, 2, 6);
      const Double4 vz = __builtin_shufflevector(__builtin_shufflevector(p, q, 2, 5, 5, 5), r, 0, 1, 4, 7);
      const Double4 speed2 = vx * vx + vy * vy + vz * vz, forever = simd::spread(kForever);
      lanes.fastest2 = speed2 <= lanes.fastest2 ? lanes.fastest2 : (speed2 < forever ? speed2 : forever);
    }
  };

  template <bool kSums, bool kSizes>
  void move_one(const MovingGrains& grains, int g) {
    double *const x = grains.position[g], *const v = grains.velocity[g], *const w = grains.spin[g];
    const double *const f = grains.force[g], *const t = grains.torque[g];
    double volume = 1.0, spread = 1.0;
    if constexpr (kSizes) {
      const double size = grains.radius[g] / radius_;
      volume = size * size * size, spread = volume * size * size;
    }
    const double per_mass = 1.0 / (mass_ * volume), per_inertia = 1.0 / (inertia_ * spread);
    for (int k = 0; k < 3; ++k) {
      const double a = f[k] * per_mass + gravity_[k], alpha = t[k] * per_inertia;
      v[k] += times_.kick * a;
      w[k] += times_.kick * alpha;
      x[k] += times_.dt * v[k];
    }
    const double speed2 = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    if (!(speed2 <= fastest2_)) fastest2_ = speed2 < kForever ? speed2 : kForever;
    if constexpr (kSums) sums_.add(x, v, w, volume, spread);
  }

  StepTimes times_;
  std::array<double, 3> gravity_{};  // m/s²
  double mass_, inertia_, radius_;   // of the reference radius, kg, kg m², m
  Twelve falls_{};                   // gravity, m/s²
  Lanes lanes_;
  double fastest2_ = 0.0;  // of grains moved singly, m²/s²
  MotionSums sums_;        // of grains moved singly; `volume` of all
};

}  // namespace furrow::terrain::liggghts
