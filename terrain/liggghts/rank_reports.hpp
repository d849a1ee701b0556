// Exchange of reports between the ranks of a terrain after an interval, as numbers in a fixed order.
#pragma once

#include <span>
#include <vector>

#include "protocol/core/rank_group.hpp"
#include "terrain/liggghts/rank_states.hpp"

namespace furrow::terrain::liggghts {

struct SharedReports {
  std::vector<IntervalReport> intervals;  // of all ranks, on each of them
  std::vector<StateReport> states;        // of all ranks, in their order, on the leader; only its own on another rank
};

/// Exchanges the reports after an interval: each rank sends one message to the leader and gets one back. Adds the
/// forces on tires over all ranks, in the order of ranks; `forces` and `sums` are valid on the leader.
/// @param group  null if there is one rank
SharedReports share_reports(RankGroup* group, const IntervalReport& interval, const StateReport& state,
                            std::span<NodalForces> forces, std::span<ContactSums> sums);

/// Highest tops of grains per cell over all ranks, on each of them.
void merge_heights(RankGroup* group, HeightField& field);

/// Reports of all ranks, in their order, on the leader; only its own on another rank.
std::vector<StateReport> gather_states(RankGroup* group, const StateReport& own);

}  // namespace furrow::terrain::liggghts
