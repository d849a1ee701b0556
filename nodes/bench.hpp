// `furrow bench`: how fast this machine steps grains. Prints one JSON object.
#pragma once

#include <string>

namespace furrow {

struct GrainBench {
  std::string bed =
      "default";  // CSV of positions (x_m,y_m,z_m), or default: the reference bed, from the cache
  std::string law = "mindlin";      // mindlin | coulomb
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

/// Every grain is integrated and every contact evaluated in every step. @throws Error
std::string bench_grains(const GrainBench& bench);

}  // namespace furrow
