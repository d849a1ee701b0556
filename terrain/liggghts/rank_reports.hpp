// What the ranks of a terrain tell each other after an interval, as numbers in a fixed order.
#pragma once

#include <span>
#include <vector>

#include "protocol/core/rank_group.hpp"
#include "terrain/liggghts/rank_states.hpp"

namespace furrow::terrain::liggghts {

/// What decides how an interval ended. All ranks receive that of all.
struct IntervalReport {
  double lost = -1.0;              // number of a grain; −1: none
  Vec3 lost_at = Vec3::Zero();     // m
  double overlap = 0.0;            // largest, m
  double share = 0.0;              // largest overlap over a diameter, -
  Vec3 hardest_at = Vec3::Zero();  // m
};
void visit_fields(FieldsOf<IntervalReport> auto& s, auto&& visit) {
  visit(s.lost, Field{"lost"});
  visit(s.lost_at, Field{"lost_at", "m"});
  visit(s.overlap, Field{"overlap", "m"});
  visit(s.share, Field{"share", "-"});
  visit(s.hardest_at, Field{"hardest_at", "m"});
}

/// What the ranks know of an interval once they have told each other.
struct SharedReports {
  std::vector<IntervalReport> intervals;  // of all ranks, on each of them
  std::vector<StateReport> states;        // of all ranks, in their order, on the leader; the own one elsewhere
};

/// After an interval, in one message of each rank to the leader and one back. Adds up what
/// tires felt on all ranks, in the
/// order of ranks; what it leaves in `forces` and `sums` counts on the leader. @param group  null: there is one rank
SharedReports share_reports(RankGroup* group, const IntervalReport& interval, const StateReport& state,
                            std::span<NodalForces> forces, std::span<ContactSums> sums);

/// Highest tops of grains per cell over all ranks, on each of them.
void merge_heights(RankGroup* group, HeightField& field);

/// Of all ranks, in their order, on the leader; the own one elsewhere.
std::vector<StateReport> gather_states(RankGroup* group, const StateReport& own);

}  // namespace furrow::terrain::liggghts
