// Cost of a step on one of the ranks of a bed. A rank owns its share of the grains and keeps copies of those
// within reach of its two borders, the ghosts. A bed of N grains and length L, cut across, has N reach/L of them at
// each border.
//   ghosts = min(2, ranks − 1) N reach/L, at most all grains of the other ranks
//   t      = c (N/ranks + ghosts)
// All grains are awake, and each rank has one core.
#pragma once

#include "terrain/dem/dem_options.hpp"

namespace furrow::terrain::liggghts {

/// Processor time of a grain-step, relative to that of engine dem in the program's measurement of this machine
/// (nodes/scenario/machine_speed.hpp): 149 to 185 against 45 to 59 ns, six times in turn (2.9 to 3.4), on 24,340 grains
/// under a flexible tire with walls, accounts and reports.
inline constexpr double kGrainStep = 3.2;

struct RankLoad {
  double own = 0.0, ghosts = 0.0;  // grains
};

/// Grains of an inner rank. @pre ranks > 0
RankLoad rank_load(const dem::DemOptions& options, int ranks);

/// Time of one step on the rank's core, s. @param grain_step  of the machine, s
double rank_step(const RankLoad& load, double grain_step);

}  // namespace furrow::terrain::liggghts
