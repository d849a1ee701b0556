// What a schema cannot say: how the values of a scenario must fit each other, its files and this machine.
#pragma once

#include "nodes/scenario/scenario.hpp"

namespace furrow::scenario {

/// Distance that a tire keeps from a wall by default: room for what it bulges, m.
inline constexpr double kWallMargin = 0.02;

/// Fills in where the axles of `rig`, the scenario's, start, checks all, and adds warnings.
/// @throws Error(bad_input)
void check_scenario(Scenario& scenario, rigs::RigSpec& rig);

}  // namespace furrow::scenario
