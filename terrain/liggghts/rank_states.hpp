// A rank's share of the terrain's state, and the sum of the shares of all ranks.
#pragma once

#include "protocol/core/terrain_state.hpp"
#include "terrain/liggghts/rank_contacts.hpp"

namespace furrow::terrain::liggghts {

struct StateReport {
  double grains = 0.0;
  RankSums sums;
  dem::Losses lost;          // J
  dem::Stored stored;        // J
  double error2 = 0.0;       // of the losses by sampling, J²
  double list_builds = 0.0;  // weighted by the rank's share of the grains
};
void visit_fields(FieldsOf<StateReport> auto& s, auto&& visit) {
  visit(s.grains, Field{"grains"});
  visit(s.sums, Field{"sums", ""});
  visit(s.lost, Field{"lost", ""});
  visit(s.stored, Field{"stored", ""});
  visit(s.error2, Field{"error2", "J²"});
  visit(s.list_builds, Field{"list_builds"});
}

/// @param grains of this rank  @param of_all grains of all ranks  @param list_builds of this rank
StateReport state_report(const RankContacts& contacts, double grains, double of_all, double list_builds);

void add(StateReport& to, const StateReport& one);

/// The terrain's state, except for refined steps, which all ranks have. @param all  sum over the ranks
/// @param gravity m/s²  @param surface_work by tires on the grains, J
TerrainState terrain_state(const StateReport& all, const dem::GrainProperties& grain, const Vec3& gravity,
                           double surface_work);

}  // namespace furrow::terrain::liggghts
