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
void visit_fields(FieldsOf<MeasureOrder> auto& s, auto&& visit) { visit(s.rims, Field{"rims", "m"}); }

/// Now attach the tires' surfaces.
struct AttachOrder {
  std::vector<SurfaceSetup> surfaces;
  std::vector<SurfaceState> start;
};
void visit_fields(FieldsOf<AttachOrder> auto& s, auto&& visit) {
  visit(s.surfaces, Field{"surfaces", ""});
  visit(s.start, Field{"start", ""});
}

/// Now advance from this step.
struct AdvanceOrder {
  StepHeader header;
  Order order = Order::go_on;      // due once that is done
  std::int64_t ends_at = kNotYet;  // the step at which the run is complete before its planned end
  std::vector<SurfaceState> targets;
};
void visit_fields(FieldsOf<AdvanceOrder> auto& s, auto&& visit) {
  visit(s.header, Field{"header", ""});
  visit(s.order, Field{"order", ""});
  visit(s.ends_at, Field{"ends_at", ""});
  visit(s.targets, Field{"targets", ""});
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
