// `furrow bench`: how fast this machine steps grains and tires. Prints one JSON object.
#pragma once

#include <string>

#include "terrain/terrain.hpp"

namespace furrow::commands {

struct GrainBench {
  std::string bed = "default";      // CSV of positions (x_m,y_m,z_m), or default: the reference bed, from the cache
  std::string law = "mindlin";      // mindlin | hertz_tanh
  std::string precision = "mixed";  // mixed | double
  double cohesion = 0.0;            // Pa
  double rolling_friction = 0.0;    // -
  double step = 4e-5;               // s
  int threads = 1;
  int steps = 1000;
  int warm = 100;       // steps before, not timed
  double settle = 0.0;  // first settled for that long at most, s
  std::string save;     // CSV that receives the positions before the timed steps; empty: none
};

/// Every grain is integrated and every contact evaluated in every step. `progress` may throw. @throws Error
std::string bench_grains(const GrainBench& bench, const ProgressCall& progress);

struct TireBench {
  std::string tire = "default";  // tire file, or default: the layered tire
  double pressure = 200e3;       // gauge, Pa
  double load = 465.0;           // carried by the spindle, kg
  double speed = 8.56;           // of the rim's spin, rad/s
  double step = 4e-5;            // s
  double tolerance = 1e-4;       // of the free residual, relative to the norm of the pressure forces
  double renewal = 0.01;         // change of shape at which a sector of the factor is renewed
  int columns = 0, width = 0;    // elements around and across; 0: the file's
  int threads = 1;
  int steps = 0;      // timed; 0: one revolution
  double warm = 0.6;  // touch-down and transients before that, s
};

/// The tire rolls freely on hard ground under a carriage. Times per step are those of the tire alone: wall time, and
/// processor time of the calling thread, also by parts. `progress` may throw. @throws Error
std::string bench_tire(const TireBench& bench, const ProgressCall& progress);

}  // namespace furrow::commands
