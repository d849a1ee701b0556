// A rank of a terrain that follows the terrain's leader: it carries out the leader's orders and computes its share.
// Only the leader exchanges messages with the tires and the rig.
#include <fmt/format.h>

#include "nodes/ranks/early_end.hpp"
#include "nodes/ranks/node.hpp"
#include "nodes/ranks/terrain_orders.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/files/fault_point.hpp"

namespace furrow::ranks {
namespace {

class TerrainFollower final : public Node {
 public:
  TerrainFollower(const scenario::Scenario& scenario, int threads, std::shared_ptr<RankGroup> group)
      : scenario_(scenario), threads_(threads), group_(std::move(group)) {
    FURROW_ASSERT(group_ && group_->rank() > 0);
    terrain::TerrainContext context = scenario.terrain_context();
    context.threads = threads;
    context.group = group_;
    terrain_ = scenario.terrain->make(context);
  }

  NodeCard card() const override {
    NodeCard card = common_card(scenario_, {Role::terrain, group_->rank()});
    card.node_kind = scenario_.terrain->describe().engine;
    card.substeps = scenario_.terrain_substeps;
    card.tire_count = static_cast<int>(scenario_.tires.size());
    card.threads = threads_;
    return card;
  }

  void set_up(Transport& transport, std::span<const NodeCard> cards, const RunContext& context) override {
    frames_ = frame_clock(scenario_, context);
    if (!context.saved) {
      terrain_->prepare(watched_progress(scenario_, transport, context));
      terrain_->gather_height_field();
      grains_begin_ = terrain_->grains_here();
      MeasureOrder measure;
      share(group_.get(), measure);
      TerrainSetup unused;
      measure_heights(scenario_, *terrain_, measure.rims, cards.subspan(1), unused);
    }
    AttachOrder attach;
    share(group_.get(), attach);
    for (std::size_t k = 0; k < attach.surfaces.size(); ++k)
      terrain_->attach(attach.surfaces[k].mesh, attach.surfaces[k].material, attach.start[k]);
    forces_.resize(attach.surfaces.size());
    contact_.resize(attach.surfaces.size());
    terrain_->gather_state();
    if (!context.saved) return;
    restore(*context.saved);
    now_.ends_at = saved_end(*context.saved);
    grains_begin_ = context.saved->get_int(kGrainsBegin);
  }

  void synchronize(Transport&, const StepHeader& header) override {
    write_frame(header);
    share(group_.get(), now_);
    if (now_.header.step != header.step)
      throw Error(ExitCode::rank_lost,
                  fmt::format("{} expected step {} from its leader but got step {}",
                              to_string(Address{Role::terrain, group_->rank()}), header.step, now_.header.step));
  }

  void advance(const StepHeader& header) override {
    FURROW_ASSERT(now_.targets.size() == forces_.size(), now_.targets.size(), forces_.size());
    const Outcome outcome =
        terrain_->advance(now_.targets, scenario_.run.step, scenario_.terrain_substeps, forces_, contact_);
    if (!outcome.ok) throw physics_error(outcome, "terrain", when(header));  // same text as the leader's
    terrain_->gather_state();
  }

  Order due() const override { return now_.order; }
  std::int64_t ends_at() const override { return now_.ends_at; }

  void finish(Transport& transport, FinalReport own, bool) override {
    terrain_->gather_height_field();
    own.grains = terrain_->grains_here();
    own.grains_begin = grains_begin_;
    send(transport, {Role::rig, 0}, own);
  }

  void save(Archive& archive) const override { terrain_->save(archive); }
  void save_setup(Archive& archive) const override {
    archive.put(kGrainsBegin, grains_begin_);
    save_end(archive, now_.ends_at);
  }
  void restore(const Archive& archive) override {
    terrain_->restore(archive);
    terrain_->gather_state();
  }

 private:
  void write_frame(const StepHeader& header) {
    if (!frames_.due(header.step)) return;
    fault_point("frame");
    terrain_->gather_frame(frame_);
    join_frames(group_.get(), frame_);
  }

  scenario::Scenario scenario_;
  int threads_;
  std::int64_t grains_begin_ = 0;  // of this rank; 0: not known
  std::shared_ptr<RankGroup> group_;
  std::unique_ptr<terrain::Terrain> terrain_;
  AdvanceOrder now_;
  std::vector<NodalForces> forces_;
  std::vector<ContactSums> contact_;
  terrain::TerrainFrame frame_;
  checkpoint::FrameClock frames_;
};

}  // namespace

std::unique_ptr<Node> make_terrain_follower(const scenario::Scenario& scenario, int threads,
                                            std::shared_ptr<RankGroup> group) {
  return std::make_unique<TerrainFollower>(scenario, threads, std::move(group));
}

}  // namespace furrow::ranks
