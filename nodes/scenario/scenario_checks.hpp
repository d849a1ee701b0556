// What a schema cannot say: how the values of a scenario must fit each other, its files and this machine.
#pragma once

#include "nodes/scenario/scenario.hpp"

namespace furrow::scenario {

/// Distance that a tire keeps from a wall by default, room for what it bulges, m: a twentieth of its radius, and at
/// most 20 mm, as much as a tire of 0.47 m bulges.
double wall_margin(double tire_radius);

/// Soil tests take a step of their own: one that is unstable in a run does not matter to them.
enum class Purpose { run, soil_tests };

/// Mounts the tires on `rig`, the scenario's, fills in where its axles start, checks all, and adds warnings.
/// @throws Error(bad_input)
void check_scenario(Scenario& scenario, rigs::RigSpec& rig, Purpose purpose);

}  // namespace furrow::scenario
