// How large the communication step may be before forces at the contact of a wheel decide the result by their timing.
//
// A tire with a motion of its own gets its forces one step late, which feeds it: its own damping must be faster, so
// H ≤ share × τ (TireDescription). Prompt forces (Scenario::prompt) are those of springs under a leapfrog rule: H ≤ 1/ω
// with the fastest of
//   bounce  ω² = k/m     k of a rigid wheel on its ground, or of a handling tire; m the tire and what moves with it
//   spin    ω² = K R²/(σ I)   of a handling tire: slip stiffness K over its relaxation length σ
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "nodes/scenario/scenario.hpp"

namespace furrow::scenario {

struct CouplingStep {
  double step = std::numeric_limits<double>::infinity();  // s
  std::string because;                                    // "the spin of its wheel on the tire's grip"
};

/// Of each wheel.
std::vector<CouplingStep> coupling_steps(const Scenario& scenario);

}  // namespace furrow::scenario
