// Turns what rig, tire and terrain report at every synchronization into lines of the time series.
#pragma once

#include <cmath>

#include "nodes/output/series_row.hpp"
#include "protocol/core/archive.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/messages.hpp"
#include "rigs/rig.hpp"

namespace furrow::output {

/// What a line of wheel k is made from; all describe the interval that ends now.
struct StepReports {
  double time = 0.0;  // t_n, s
  rigs::WheelReport wheel;
  RimState rim;
  SpindleReport tire;
  ContactSums contact;
  TerrainState terrain;
  std::int64_t grains = 0;
  Vec3 travel = Vec3::UnitX();
};

class SeriesBuilder {
 public:
  /// @param radius undeformed tire radius, m
  /// @param ground undisturbed surface height h₀, m
  /// @pre radius > 0, step > 0
  SeriesBuilder(double radius, double ground, double step) : radius_(radius), ground_(ground), step_(step) {
    FURROW_ASSERT(radius > 0.0 && step > 0.0, radius, step);
    FURROW_ASSERT(std::isfinite(ground), ground);
  }

  /// Once per synchronization n ≥ 1. @pre time grows; travel is a unit vector
  void add(const StepReports& reports);
  /// The line for the intervals added since the last take().
  SeriesRow take();

  /// Σ|impulse sent per interval| up to the one before the last: the interval in flight excluded, N s.
  double impulse_sent_abs() const { return memory_.sent_abs_arrived; }
  /// Impulse sent up to the interval before the last, which is what the tire has received by now, N s.
  Vec3 impulse_sent_arrived() const { return memory_.sent_arrived; }
  /// Instants and cumulative values as of the last add(); its means are not yet divided.
  const SeriesRow& now() const { return memory_.row; }

  void save(Archive& archive) const;
  void restore(const Archive& archive);

 private:
  void add_means(const StepReports& r);
  void add_tire_axes(const StepReports& r);
  void add_work(const StepReports& r);
  void set_instants(const StepReports& r);

  /// Everything that is carried from one synchronization to the next; doubles only, saved as they stand.
  struct Memory {
    SeriesRow row;                                  // sums of interval means; instants; cumulative values
    double count = 0.0;                             // intervals in row
    double started = 0.0;                           // 1 once an interval was added
    double last_terrain_work = 0.0;                 // done by the terrain in the interval before, J
    double last_tire_work = 0.0;                    // cumulative until the interval before, J
    double last_rim_work = 0.0;                     // done on the tire in the interval before, J
    Vec3 sent = Vec3::Zero();                       // cumulative impulse, N s
    Vec3 sent_arrived = Vec3::Zero();               // the same, without the interval in flight, N s
    double sent_abs = 0.0, sent_abs_arrived = 0.0;  // N s
    double load = 0.0;                              // weight carried by the wheel, N
    Wrench last_spindle;
    Vec3 last_rim_position = Vec3::Zero();      // m
    Vec3 last_angular_velocity = Vec3::Zero();  // rad/s
  };
  static_assert(sizeof(Memory) % sizeof(double) == 0);

  double radius_, ground_, step_;
  Memory memory_;
};

}  // namespace furrow::output
