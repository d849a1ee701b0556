// The terrain's rank: prepares the bed, says how high it stands under each tire, then pushes back.
#include "nodes/output/frames.hpp"
#include "nodes/ranks/early_end.hpp"
#include "nodes/ranks/node.hpp"
#include "nodes/ranks/saved_forces.hpp"
#include "protocol/core/archive_fields.hpp"
#include "protocol/core/assert.hpp"

namespace furrow::ranks {
namespace {

constexpr double kFootprintShare =
    0.6;  // of the tire radius ahead and behind: where a grain can touch it at rest

std::string forces_name(std::size_t tire) { return "node/forces" + std::to_string(tire); }
std::string contact_name(std::size_t tire) { return "node/contact" + std::to_string(tire); }

class TerrainNode : public Node {
 public:
  TerrainNode(const scenario::Scenario& scenario, int threads) : scenario_(scenario), threads_(threads) {
    terrain::TerrainContext context = scenario.terrain_context();
    context.threads = threads;
    terrain_ = scenario.terrain->make(context);
  }

  NodeCard card() const override {
    NodeCard card = common_card(scenario_, kSelf);
    card.node_kind = scenario_.terrain->describe().engine;
    card.substeps = scenario_.terrain_substeps;
    card.tire_count = static_cast<int>(scenario_.tires.size());
    card.threads = threads_;
    card.size = terrain_->size();
    return card;
  }

  void set_up(Transport& transport, std::span<const NodeCard> cards, const RunContext& context) override {
    directory_ = context.directory;
    held_ = context.held;
    frames_ = frame_clock(scenario_, context);
    const int tires = static_cast<int>(scenario_.tires.size());
    std::vector<SurfaceSetup> surfaces;
    for (int k = 0; k < tires; ++k) surfaces.push_back(receive<SurfaceSetup>(transport, {Role::tire, k}));

    std::vector<Vec3> rims;
    if (context.saved)
      restore_setup(*context.saved);
    else
      prepare(transport, context);
    for (int k = 0; k < tires; ++k)
      rims.push_back(receive_step<RimMotion>(transport, kRig, kPlacement).rim.position);
    if (!context.saved) measure(rims, cards);
    send(transport, kRig, setup_);

    targets_.resize(tires);
    forces_.resize(tires);
    report_.contact.assign(tires, {});
    for (int k = 0; k < tires; ++k) {
      targets_[k] = receive_step<SurfaceMotion>(transport, {Role::tire, k}, kPlacement).surface;
      terrain_->attach(surfaces[k].mesh, surfaces[k].material, targets_[k]);
    }
    report_.state = terrain_->state();
    if (!context.saved) return;
    restore(*context.saved);
    ends_at_ = saved_end(*context.saved);
  }

  void synchronize(Transport& transport, const StepHeader& header) override {
    write_frame(header);
    report_.header = header;
    for (int k = 0; k < static_cast<int>(forces_.size()); ++k)
      send(transport, Address{Role::tire, k}, TerrainForces{header, forces_[k]});
    send(transport, kRig, report_);
    for (int k = 0; k < static_cast<int>(forces_.size()); ++k) {
      SurfaceMotion motion = receive_step<SurfaceMotion>(transport, {Role::tire, k}, header.step);
      targets_[k] = std::move(motion.surface);
      due_ = motion.order;
      ends_at_ = motion.ends_at;
    }
  }

  void advance(const StepHeader& header) override {
    FURROW_ASSERT(targets_.size() == forces_.size(), targets_.size(), forces_.size());
    FURROW_ASSERT(report_.contact.size() == forces_.size(), report_.contact.size(), forces_.size());
    const Outcome outcome =
        terrain_->advance(targets_, scenario_.run.step, scenario_.terrain_substeps, forces_, report_.contact);
    if (!outcome.ok) throw physics_error(outcome, "terrain", when(header));
    report_.state = terrain_->state();
  }

  Order due() const override { return due_; }
  std::int64_t ends_at() const override { return ends_at_; }

  void finish(Transport& transport, FinalReport own, bool) override {
    own.height_before = before_;
    own.height_after = terrain_->height_field();
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
    save_fields(archive, kBefore, before_);
    save_end(archive, ends_at_);
  }

  void restore(const Archive& archive) override {
    terrain_->restore(archive);
    for (std::size_t k = 0; k < forces_.size(); ++k) {
      restore_forces(archive, forces_name(k), targets_[k].position.size(), forces_[k]);
      restore_fields(archive, contact_name(k), report_.contact[k]);
    }
    report_.state = terrain_->state();
  }

 private:
  static constexpr Address kSelf{Role::terrain, 0};
  static constexpr Address kRig{Role::rig, 0};
  static constexpr char kSetup[] = "setup", kBefore[] = "setup/height_before";  // in the saved state

  void prepare(Transport& transport, const RunContext& context) {
    setup_.settle_wall_s = terrain_->prepare([&](const std::string& what, double share) {
      transport.heartbeat();
      transport.check_peers();
      if (context.stop_requested && context.stop_requested())
        throw Error(ExitCode::stopped, "stopped by a signal while the bed was being prepared");
      launch::Progress progress;
      progress.phase = what;
      progress.share = share;
      progress.end = scenario_.run.end;
      if (context.progress) context.progress(progress);
    });
    setup_.grains = terrain_->size();
    setup_.floor_height = terrain_->floor_height();
    before_ = terrain_->height_field();
  }

  /// Heights under the tires' footprints.
  void measure(std::span<const Vec3> rims, std::span<const NodeCard> cards) {
    const terrain::TerrainDescription terrain = scenario_.terrain->describe();
    const double length = terrain.bounds ? terrain.bounds->length : 0.0;
    for (std::size_t k = 0; k < rims.size(); ++k) {
      const Vec3& at = rims[k];
      const double reach = kFootprintShare * cards[1 + k].tire_radius, half = 0.5 * cards[1 + k].tire_width;
      setup_.top_height.push_back(
          terrain_->top_height(at.x() - reach, at.x() + reach, at.y() - 1.5 * half, at.y() + 1.5 * half));
      setup_.mean_height.push_back(
          terrain.undisturbed_height
              ? *terrain.undisturbed_height
              : terrain_->mean_height(0.1 * length, 0.9 * length, at.y() - half, at.y() + half));
    }
  }

  void restore_setup(const Archive& archive) {
    restore_fields(archive, kSetup, setup_);
    restore_fields(archive, kBefore, before_);
  }

  void write_frame(const StepHeader& header) {
    if (!frames_.due(header.step)) return;
    if (held_) held_->check();
    terrain_->frame(frame_);
    output::write_terrain_frame(directory_, frames_.index(header.step), header.time, frame_);
  }

  scenario::Scenario scenario_;
  int threads_;
  std::unique_ptr<terrain::Terrain> terrain_;
  std::vector<SurfaceState> targets_;
  std::vector<NodalForces> forces_;
  TerrainReport report_;
  TerrainSetup setup_;
  HeightField before_;
  terrain::TerrainFrame frame_;
  std::filesystem::path directory_;
  launch::HeldFolder* held_ = nullptr;
  checkpoint::FrameClock frames_;
  Order due_ = Order::go_on;
  std::int64_t ends_at_ = kNotYet;
};

}  // namespace

std::unique_ptr<Node> make_terrain_node(const scenario::Scenario& scenario, int threads) {
  return std::make_unique<TerrainNode>(scenario, threads);
}

}  // namespace furrow::ranks
