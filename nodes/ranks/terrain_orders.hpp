// The orders that the leader of a terrain of several ranks sends to the others, so that all of them call the same verbs
// of the terrain in the same order: prepare, measure, attach, advance, frame. All prepare first of all, without an
// order. Saving and ending follow the run loop, which is every rank's own.
#pragma once

#include <span>
#include <vector>

#include "nodes/ranks/run_context.hpp"
#include "nodes/scenario/scenario.hpp"
#include "protocol/core/rank_group.hpp"
#include "protocol/messages.hpp"
#include "protocol/transport.hpp"
#include "terrain/terrain.hpp"

namespace furrow::ranks {

/// In the saved state: how many grains a rank of a terrain of several owned when the run began.
inline constexpr char kGrainsBegin[] = "setup/grains_begin";

/// Now measure it under the tires.
struct MeasureOrder {
  std::vector<Vec3> rims;  // where they will stand, m
};
void visit_fields(auto&& visit, FieldsOf<MeasureOrder> auto& s) { visit(Field{"rims", "m"}, s.rims); }

/// Now attach the tires' surfaces.
struct AttachOrder {
  std::vector<SurfaceSetup> surfaces;
  std::vector<SurfaceState> start;
};
void visit_fields(auto&& visit, FieldsOf<AttachOrder> auto& s) {
  visit(Field{"surfaces", ""}, s.surfaces);
  visit(Field{"start", ""}, s.start);
}

/// Now advance from this step.
struct AdvanceOrder {
  StepHeader header;
  Order order = Order::go_on;      // due once that is done
  std::int64_t ends_at = kNotYet;  // the step at which the run is complete before its planned end
  std::vector<SurfaceState> targets;
};
void visit_fields(auto&& visit, FieldsOf<AdvanceOrder> auto& s) {
  visit(Field{"header", ""}, s.header);
  visit(Field{"order", ""}, s.order);
  visit(Field{"ends_at", ""}, s.ends_at);
  visit(Field{"targets", ""}, s.targets);
}

/// The leader gives an order, the others receive it. A terrain of one rank (no group) sends none.
template <class M>
void share(RankGroup* group, M& order);

/// What a rank calls while its terrain prepares itself: it shows that it lives, ends where another has failed or the
/// user wants it to, and hands progress on.
ProgressCall watched_progress(const scenario::Scenario& scenario, Transport& transport, const RunContext& context);

/// Heights of the terrain under the tires' footprints, into `setup`.
/// @param tires cards of the tires
void measure_heights(const scenario::Scenario& scenario, const terrain::Terrain& terrain, std::span<const Vec3> rims,
                     std::span<const NodeCard> tires, TerrainSetup& setup);

/// The frame of the whole terrain on its leader, of each rank's own share before.
void join_frames(RankGroup* group, terrain::TerrainFrame& frame);

}  // namespace furrow::ranks
