// Checks beyond the schema: the values of a scenario must fit each other, its files and this machine.
#pragma once

#include "nodes/scenario/scenario.hpp"

namespace furrow::scenario {

/// Default distance of a tire from a wall, for its bulge, m: a twentieth of its radius, and at most 20 mm, the bulge of
/// a tire of 0.47 m.
double wall_margin(double tire_radius);

/// Soil tests have a step of their own, so a step that is unstable in a run does not affect them.
enum class Purpose { run, soil_tests };

/// Mounts the tires on `rig`, the scenario's, fills in the starts of its axles, checks everything, and adds warnings.
/// @throws Error(bad_input)
void check_scenario(Scenario& scenario, rigs::RigSpec& rig, Purpose purpose);

}  // namespace furrow::scenario
