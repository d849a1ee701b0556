// Makes lines of a wheel's table from the reports of rig, tire and terrain at every synchronization.
#pragma once

#include <vector>

#include "nodes/output/line_builder.hpp"
#include "nodes/output/wheel_row.hpp"
#include "protocol/core/archive.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/messages.hpp"
#include "rigs/rig.hpp"

namespace furrow::output {

/// Inputs for a line of wheel k; all describe the interval that ends now.
struct StepReports {
  double time = 0.0;  // t_n, s
  rigs::WheelReport wheel;
  RimState rim;
  SpindleReport tire;
  ContactSums contact;
  TerrainState terrain;
  std::int64_t grains = 0;
  Vec3 heading = Vec3::UnitX();  // unit, at the interval's end
};

class SeriesBuilder {
 public:
  /// @param radius undeformed tire radius, m
  /// @param ground undisturbed surface height h₀, m
  /// @param level the surface has that height everywhere
  /// @pre radius > 0, step > 0
  SeriesBuilder(double radius, double ground, double step, bool level = true);

  /// Call it once per synchronization n ≥ 1. @pre time grows; travel is a unit vector
  void add(const StepReports& reports);
  /// Returns the line for the intervals added since the last take().
  WheelRow take();

  /// Σ|impulse sent per interval| up to the last but one interval: the interval in flight is excluded, N s.
  double impulse_sent_abs() const { return memory_.sent_abs_arrived; }
  /// Impulse sent up to the last but one interval, which the tire has received by now, N s.
  Vec3 impulse_sent_arrived() const { return memory_.sent_arrived; }
  /// Instants and cumulative values after the last add(); its means are not yet divided.
  WheelRow now() const;
  /// Values of the last interval alone; cumulative columns are since the start.
  const WheelRow& last() const { return row_; }

  void save(Archive& archive) const;
  void restore(const Archive& archive);

  /// Values carried from one synchronization to the next besides the lines.
  struct Memory {
    double started = 0.0;                           // 1 once an interval was added
    double rolled = 0.0;                            // Σ speed in the wheel's plane since the last line, m/s
    double last_terrain_work = 0.0;                 // done by the terrain in the interval before, J
    double last_tire_work = 0.0;                    // cumulative until the interval before, J
    double last_rim_work = 0.0;                     // done on the tire in the interval before, J
    Vec3 sent = Vec3::Zero();                       // cumulative impulse, N s
    Vec3 sent_arrived = Vec3::Zero();               // cumulative impulse without the interval in flight, N s
    double sent_abs = 0.0, sent_abs_arrived = 0.0;  // N s
    Wrench last_spindle;                            // on the rim by the tire, N, N m
    Vec3 last_rim_position = Vec3::Zero();          // m
    Vec3 last_angular_velocity = Vec3::Zero();      // rad/s
  };

 private:
  void measure_means(const StepReports& r);
  void measure_tire_axes(const StepReports& r);
  void measure_work(const StepReports& r);
  void measure_instants(const StepReports& r);

  double radius_, ground_, step_;
  bool level_;
  WheelRow row_;  // of the last interval: cumulative and largest values continue from it
  LineBuilder lines_;
  std::vector<double> values_;  // of row_
  Memory memory_;
};

void visit_fields(FieldsOf<SeriesBuilder::Memory> auto& m, auto&& visit) {
  visit(m.started, Field{"started"});
  visit(m.rolled, Field{"rolled", "m/s"});
  visit(m.last_terrain_work, Field{"last_terrain_work", "J"});
  visit(m.last_tire_work, Field{"last_tire_work", "J"});
  visit(m.last_rim_work, Field{"last_rim_work", "J"});
  visit(m.sent, Field{"sent", "N s"});
  visit(m.sent_arrived, Field{"sent_arrived", "N s"});
  visit(m.sent_abs, Field{"sent_abs", "N s"});
  visit(m.sent_abs_arrived, Field{"sent_abs_arrived", "N s"});
  visit(m.last_spindle.force, Field{"last_spindle_force", "N"});
  visit(m.last_spindle.moment, Field{"last_spindle_moment", "N m"});
  visit(m.last_rim_position, Field{"last_rim_position", "m"});
  visit(m.last_angular_velocity, Field{"last_angular_velocity", "rad/s"});
}

}  // namespace furrow::output
