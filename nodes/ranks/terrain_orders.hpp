// Orders from the leader of a terrain of several ranks to the others, so that all call the same functions of the
// terrain in the same order: prepare, measure, attach, advance, frame. All prepare first, without an order. Saving and
// ending follow the run loop of each rank.
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

/// In the saved state: number of grains that a rank of such a terrain owned when the run began.
inline constexpr char kGrainsBegin[] = "setup/grains_begin";

struct MeasureOrder {
  std::vector<Vec3> rims;  // where they will be, m
};
void visit_fields(FieldsOf<MeasureOrder> auto& s, auto&& visit) { visit(s.rims, Field{"rims", "m"}); }

struct AttachOrder {
  std::vector<SurfaceSetup> surfaces;
  std::vector<SurfaceState> start;
};
void visit_fields(FieldsOf<AttachOrder> auto& s, auto&& visit) {
  visit(s.surfaces, Field{"surfaces", ""});
  visit(s.start, Field{"start", ""});
}

struct AdvanceOrder {
  StepHeader header;
  Order order = Order::go_on;      // due after the advance
  std::int64_t ends_at = kNotYet;  // the step at which the run is complete before its planned end
  std::vector<SurfaceState> targets;
};
void visit_fields(FieldsOf<AdvanceOrder> auto& s, auto&& visit) {
  visit(s.header, Field{"header", ""});
  visit(s.order, Field{"order", ""});
  visit(s.ends_at, Field{"ends_at", ""});
  visit(s.targets, Field{"targets", ""});
}

/// The leader sends an order, the others receive it. A terrain of one rank (no group) sends none.
template <class M>
void share(RankGroup* group, M& order);

/// Progress call for a rank while its terrain prepares itself: it shows that the rank lives, ends if another rank has
/// failed or the user stops it, and passes progress on.
ProgressCall watched_progress(const scenario::Scenario& scenario, Transport& transport, const RunContext& context);

/// Puts the heights of the terrain under the tires' footprints into `setup`.
/// @param tires cards of the tires
void measure_heights(const scenario::Scenario& scenario, const terrain::Terrain& terrain, std::span<const Vec3> rims,
                     std::span<const NodeCard> tires, TerrainSetup& setup);

/// Joins the ranks' shares of a frame to the frame of the whole terrain on its leader.
void join_frames(RankGroup* group, terrain::TerrainFrame& frame);

}  // namespace furrow::ranks
