// Checks whether a scenario can run: each of its tires needs a model that moves.
#pragma once

#include "nodes/scenario/scenario.hpp"

namespace furrow::scenario {

/// @throws Error(bad_input) naming the key of a tire that can only be pressed
void require_runnable(const Scenario& scenario);

}  // namespace furrow::scenario
