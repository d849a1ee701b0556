// A scenario to begin with: a wheel or a vehicle on soil, with a comment for every key. Whatever has a scale follows
// from the tires: a rover's wheel gets smaller grains, a shorter bed and a shorter time than a truck's.
#pragma once

#include <filesystem>
#include <string>

namespace furrow::scenario {

struct StarterOptions {
  std::string tire;     // file; empty: the layered tire, or those of the vehicle
  std::string soil;     // file; empty: the cohesive soil of the shipped scenarios
  std::string vehicle;  // file; empty: one wheel on a drawbar rig
  bool rigid = false;   // the tires keep their shape
  double load = 0.0;    // that the wheel carries, N; 0: by its size, as the reference tire carries 4.6 kN
};

/// Writes the scenario, checks it, and chooses its step from the stable one. What is wrong leaves no file.
/// @param file that does not exist yet
/// @throws Error(bad_input) naming file and key
void write_starter(const std::filesystem::path& file, const StarterOptions& options);

}  // namespace furrow::scenario
