// A settled bed for a distributed engine: from the solver of terrain/dem on the leader to all ranks.
#pragma once

#include <span>
#include <vector>

#include "protocol/core/rank_group.hpp"
#include "terrain/dem/grain_solver.hpp"
#include "terrain/liggghts/engine.hpp"

namespace furrow::terrain::liggghts {

struct StartingBed {
  std::vector<NewGrain> grains;
  std::vector<PairRecord> pairs;
  std::vector<CarriedBy> walls;
  double top = 0.0;  // height that no grain exceeds, m

  std::int64_t size() const { return static_cast<std::int64_t>(grains.size()); }
};

/// Grains in the order of cells.
StartingBed starting_bed(const dem::GrainSolver& solver);
/// Sets the solver's grains from a bed. @pre grains are in the order of their numbers, 0, 1, …
void begin_from(dem::GrainSolver& solver, const StartingBed& bed);

/// Gives a rank's own grains their histories.
void hand_out(std::span<const CarriedBy> carried, const OwnGrains& own);

/// Sends the leader's bed to all ranks. @param group null if there is one rank
void share(RankGroup* group, StartingBed& bed);

}  // namespace furrow::terrain::liggghts
