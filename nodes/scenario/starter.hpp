// A first scenario: a wheel or a vehicle on soil, with a comment for every key. All scales follow from the tires: a
// rover's wheel gets smaller grains, a shorter bed and a shorter time than a truck's.
#pragma once

#include <filesystem>
#include <string>

namespace furrow::scenario {

struct StarterOptions {
  std::string tire;     // file; empty: the layered tire, or those of the vehicle
  std::string soil;     // file; empty: the cohesive soil of the shipped scenarios
  std::string vehicle;  // file; empty: one wheel on a drawbar rig
  bool rigid = false;   // rigid tires
  double load = 0.0;    // of the wheel, N; 0: by its size, scaled from the reference tire's 4.6 kN
};

/// Writes the scenario, checks it, and chooses its step from the stable one. A mistake leaves no file.
/// @param file must not exist yet
/// @throws Error(bad_input) naming file and key
void write_starter(const std::filesystem::path& file, const StarterOptions& options);

}  // namespace furrow::scenario
