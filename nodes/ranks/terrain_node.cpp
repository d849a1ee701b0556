// The terrain's rank: prepares the bed, reports its height under each tire, then computes the forces on the tires. In a
// terrain of several ranks it is the leader and orders what all of them do (terrain_orders.hpp).
#include <algorithm>
#include <cmath>

#include "nodes/output/frames.hpp"
#include "nodes/ranks/early_end.hpp"
#include "nodes/ranks/node.hpp"
#include "nodes/ranks/saved_forces.hpp"
#include "nodes/ranks/terrain_orders.hpp"
#include "nodes/ranks/thread_trial.hpp"
#include "protocol/contact_statement.hpp"
#include "protocol/core/archive_fields.hpp"
#include "protocol/core/assert.hpp"

namespace furrow::ranks {
namespace {

std::string forces_name(std::size_t tire) { return "node/forces" + std::to_string(tire); }
std::string contact_name(std::size_t tire) { return "node/contact" + std::to_string(tire); }

class TerrainNode : public Node {
 public:
  TerrainNode(const scenario::Scenario& scenario, int threads, std::shared_ptr<RankGroup> group)
      : scenario_(scenario), threads_(threads), group_(std::move(group)) {
    FURROW_ASSERT(!group_ || group_->rank() == 0);
    terrain::TerrainContext context = scenario.terrain_context();
    context.threads = threads;
    context.group = group_;
    terrain_ = scenario.terrain->make(context);
  }

  NodeCard card() const override {
    NodeCard card = common_card(scenario_, kSelf);
    card.node_kind = scenario_.terrain->describe().engine;
    card.substeps = scenario_.terrain_substeps;
    card.tire_count = static_cast<int>(scenario_.tires.size());
    card.threads = threads_.now();
    card.size = terrain_->size();
    return card;
  }

  void set_up(Transport& transport, std::span<const NodeCard> cards, const RunContext& context) override {
    directory_ = context.directory;
    held_ = context.held;
    threads_ = ThreadTrial(context.threads, context.other_threads);
    frames_ = frame_clock(scenario_, context);
    const int tires = static_cast<int>(scenario_.tires.size());
    AttachOrder attach;
    for (int k = 0; k < tires; ++k) attach.surfaces.push_back(receive<SurfaceSetup>(transport, {Role::tire, k}));

    MeasureOrder measure;
    if (context.saved)
      restore_setup(*context.saved);
    else
      prepare(transport, context);
    for (int k = 0; k < tires; ++k)
      measure.rims.push_back(receive_step<RimMotion>(transport, kRig, kPlacement).rim.position);
    if (!context.saved) {
      share(group_.get(), measure);
      measure_heights(scenario_, *terrain_, measure.rims, cards.subspan(1), setup_);
    }
    send(transport, kRig, setup_);

    forces_.resize(tires);
    stated_.resize(tires);
    for (int k = 0; k < tires; ++k) {
      states_contact_.push_back(!scenario_.tires[k]->describe().own_contact.empty());
      prompt_.push_back(scenario_.prompt(k));
      FURROW_ASSERT(prompt_[k] || !states_contact_[k], k);
    }
    report_.contact.assign(tires, {});
    for (int k = 0; k < tires; ++k)
      attach.start.push_back(receive_step<SurfaceMotion>(transport, {Role::tire, k}, kPlacement).surface);
    share(group_.get(), attach);
    for (int k = 0; k < tires; ++k) try {
        terrain_->attach(attach.surfaces[k].mesh, attach.surfaces[k].material, attach.start[k]);
      } catch (const Error& error) {
        throw Error(error.code(), fmt::format("{}: tire {}: {}", scenario_.file.string(), k, error.what()));
      }
    now_.targets = std::move(attach.start);
    report_.state = terrain_->gather_state();
    if (!context.saved) return;
    restore(*context.saved);
    now_.ends_at = saved_end(*context.saved);
  }

  void synchronize(Transport& transport, const StepHeader& header) override {
    write_frame(header);
    report_.header = header;
    for (int k = 0; k < static_cast<int>(forces_.size()); ++k)
      if (!prompt_[k]) send(transport, Address{Role::tire, k}, TerrainForces{header, forces_[k]});
    send(transport, kRig, report_);
    for (int k = 0; k < static_cast<int>(forces_.size()); ++k) {
      SurfaceMotion motion = receive_step<SurfaceMotion>(transport, {Role::tire, k}, header.step);
      if (!prompt_[k]) now_.targets[k] = std::move(motion.surface);
      now_.order = motion.order;
      now_.ends_at = motion.ends_at;
    }
    now_.header = header;
    share(group_.get(), now_);
  }

  void answer(Transport& transport, const StepHeader& header) override {
    if (!any_prompt()) return;
    for (int k = 0; k < static_cast<int>(forces_.size()); ++k) {
      if (!prompt_[k]) continue;
      now_.targets[k] = receive_step<SurfaceMotion>(transport, {Role::tire, k}, header.step).surface;
      if (states_contact_[k])
        stated_[k] = receive_step<ContactStatement>(transport, {Role::tire, k}, header.step).contact;
    }
    move(header);
    for (int k = 0; k < static_cast<int>(forces_.size()); ++k)
      if (prompt_[k]) send(transport, Address{Role::tire, k}, TerrainForces{header, forces_[k]});
  }

  void advance(const StepHeader& header) override {
    if (!any_prompt()) move(header);
  }

  Order due() const override { return now_.order; }
  std::int64_t ends_at() const override { return now_.ends_at; }

  void finish(Transport& transport, FinalReport own, bool) override {
    own.threads = threads_.now();
    own.height_before = height_before_;
    own.height_after = terrain_->gather_height_field();
    own.grains = terrain_->grains_here();
    own.grains_begin = grains_begin_;
    send(transport, kRig, own);
  }

  void save(Archive& archive) const override {
    terrain_->save(archive);
    for (std::size_t k = 0; k < forces_.size(); ++k) {
      save_fields(archive, forces_name(k), forces_[k]);
      save_fields(archive, contact_name(k), report_.contact[k]);
    }
  }

  void save_setup(Archive& archive) const override {
    save_fields(archive, kSetup, setup_);
    save_fields(archive, kBefore, height_before_);
    if (group_) archive.put(kGrainsBegin, grains_begin_);
    save_end(archive, now_.ends_at);
  }

  void restore(const Archive& archive) override {
    terrain_->restore(archive);
    for (std::size_t k = 0; k < forces_.size(); ++k) {
      restore_forces(archive, forces_name(k), now_.targets[k].position.size(), forces_[k]);
      restore_fields(archive, contact_name(k), report_.contact[k]);
    }
    report_.state = terrain_->gather_state();
  }

 private:
  static constexpr Address kSelf{Role::terrain, 0};
  static constexpr Address kRig{Role::rig, 0};
  static constexpr char kSetup[] = "setup", kBefore[] = "setup/height_before";  // in the saved state

  bool any_prompt() const { return std::ranges::find(prompt_, true) != prompt_.end(); }

  void move(const StepHeader& header) {
    FURROW_ASSERT(now_.targets.size() == forces_.size(), now_.targets.size(), forces_.size());
    FURROW_ASSERT(report_.contact.size() == forces_.size(), report_.contact.size(), forces_.size());
    choose_threads();
    terrain_->state_contacts(stated_);
    const Outcome outcome =
        terrain_->advance(now_.targets, scenario_.run.step, scenario_.terrain_substeps, forces_, report_.contact);
    if (!outcome.ok) throw physics_error(outcome, "terrain", when(header));
    report_.state = terrain_->gather_state();
  }

  void choose_threads() {
    const double now = wall_clock();
    const int before = threads_.now();
    if (moved_at_ > 0.0) threads_.step_took(now - moved_at_);
    moved_at_ = now;
    if (threads_.now() != before) terrain_->set_threads(threads_.now());
  }

  void prepare(Transport& transport, const RunContext& context) {
    setup_.settle_wall_s = terrain_->prepare(watched_progress(scenario_, transport, context));
    setup_.grains = terrain_->size();
    setup_.floor_height = terrain_->floor_height();
    height_before_ = terrain_->gather_height_field();
    const terrain::TerrainDescription described = scenario_.terrain->describe();
    if (described.grain_radius > 0.0 && described.undisturbed_height)  // a later pass: its rut counts from there too
      for (double& height : height_before_.height)
        if (std::isfinite(height)) height = *described.undisturbed_height;
    grains_begin_ = terrain_->grains_here();
  }

  void restore_setup(const Archive& archive) {
    restore_fields(archive, kSetup, setup_);
    restore_fields(archive, kBefore, height_before_);
    if (group_) grains_begin_ = archive.get_int(kGrainsBegin);
  }

  void write_frame(const StepHeader& header) {
    if (!frames_.due(header.step)) return;
    if (held_) held_->check();
    terrain_->gather_frame(frame_);
    join_frames(group_.get(), frame_);
    output::write_terrain_frame(directory_, frames_.index(header.step), header.time, frame_);
  }

  scenario::Scenario scenario_;
  ThreadTrial threads_;
  double moved_at_ = 0.0;             // wall time of the last step's begin, s
  std::shared_ptr<RankGroup> group_;  // null: the only rank
  std::unique_ptr<terrain::Terrain> terrain_;
  std::vector<bool> states_contact_, prompt_;  // of each tire
  std::vector<StatedContact> stated_;          // by the tires, for the current step
  AdvanceOrder now_;
  std::vector<NodalForces> forces_;
  TerrainReport report_;
  TerrainSetup setup_;
  HeightField height_before_;
  std::int64_t grains_begin_ = 0;  // of this rank
  terrain::TerrainFrame frame_;
  std::filesystem::path directory_;
  launch::HeldFolder* held_ = nullptr;
  checkpoint::FrameClock frames_;
};

}  // namespace

std::unique_ptr<Node> make_terrain_node(const scenario::Scenario& scenario, int threads,
                                        std::shared_ptr<RankGroup> group) {
  return std::make_unique<TerrainNode>(scenario, threads, std::move(group));
}

}  // namespace furrow::ranks
