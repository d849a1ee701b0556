// What a run of a scenario will need, before any rank exists.
#pragma once

#include <cstdint>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "nodes/scenario.hpp"

namespace furrow {

struct Estimate {
  TerrainEstimate terrain;
  std::int64_t steps = 0;        // communication steps
  std::int64_t coordinates = 0;  // of all tires
  double memory = 0.0;           // of all ranks, bytes
  double disk = 0.0;             // of the results, bytes
};

Estimate estimate(const Scenario& scenario);

/// What this machine has to give now; 0 where unknown.
struct MachineState {
  double memory_free = 0.0;  // bytes
  double disk_free = 0.0;    // in the working directory, bytes
};
MachineState machine_state();

/// What `furrow validate` prints: the figures by name, or as lines for people.
nlohmann::ordered_json validation_report(const Scenario& scenario);
std::string validation_text(const Scenario& scenario);

}  // namespace furrow
