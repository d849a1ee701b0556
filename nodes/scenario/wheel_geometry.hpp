// Sizes of a scenario's tires and paths of their axles, before any model is made.
#pragma once

#include <vector>

#include "nodes/scenario/scenario.hpp"

namespace furrow::scenario {

/// In the order of the wheels. @throws Error(bad_input) naming file and key
std::vector<tire::TireDescription> describe_tires(const Scenario& scenario);

std::vector<rigs::WheelSize> wheel_sizes(const std::vector<tire::TireDescription>& tires);

/// Values that a rig may take from the scenario's tires, described as `tires`.
std::vector<rigs::MountedTire> mounted_tires(const Scenario& scenario, const std::vector<tire::TireDescription>& tires);

/// Describes the rig with the scenario's tires over its whole run. @throws Error(bad_input) naming file and key
rigs::RigDescription describe_rig(const Scenario& scenario);
rigs::RigDescription describe_rig(const Scenario& scenario, const std::vector<tire::TireDescription>& tires);

}  // namespace furrow::scenario
