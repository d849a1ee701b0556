// The terrain's rank: prepares the bed, says how high it stands under each tire, then pushes back.
#include <algorithm>

#include "nodes/output/frames.hpp"
#include "nodes/ranks/node.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/core/flat.hpp"

namespace furrow::ranks {
namespace {

constexpr double kFootprintShare =
    0.6;  // of the tire radius ahead and behind: where a grain can touch it at rest

void save_tangents(Archive& archive, const std::string& name, const NodalForces& forces) {
  if (forces.tangent.empty()) return;
  std::vector<double> flat;
  for (const ContactTangent& t : forces.tangent)
    append_numbers(flat, t.stiffness, t.damping, t.position, t.velocity);
  archive.put(name + "/tangent", flat);
}

void restore_tangents(const Archive& archive, const std::string& name, NodalForces& forces) {
  forces.tangent.clear();
  if (!archive.has(name + "/tangent")) return;
  forces.tangent.resize(forces.vertex.size());
  const double* from = archive.get<double>(name + "/tangent", 24 * forces.tangent.size()).data();
  for (ContactTangent& t : forces.tangent)
    from = take_numbers(from, t.stiffness, t.damping, t.position, t.velocity);
}

class TerrainNode : public Node {
 public:
  TerrainNode(const scenario::Scenario& scenario, int threads) : scenario_(scenario), threads_(threads) {
    terrain::TerrainOptions options = scenario.terrain;
    options.threads = threads;
    terrain_ = terrain::make_terrain(options);
  }

  NodeCard card() const override {
    NodeCard card = common_card(scenario_, kSelf);
    card.node_kind = scenario_.terrain.engine;
    card.substeps = scenario_.terrain_substeps;
    card.tire_count = static_cast<int>(scenario_.tires.size());
    card.threads = threads_;
    card.size = terrain_->size();
    return card;
  }

  void set_up(Transport& transport, std::span<const NodeCard> cards, const RunContext& context) override {
    directory_ = context.directory;
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
    if (context.saved) restore(*context.saved);
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

  void finish(Transport& transport, FinalReport own, bool) override {
    own.height_before = before_;
    own.height_after = terrain_->height_field();
    send(transport, kRig, own);
  }

  void save(Archive& archive) const override {
    terrain_->save(archive);
    for (std::size_t k = 0; k < forces_.size(); ++k) {
      const std::string name = "node/forces" + std::to_string(k);
      archive.put(name + "/vertex",
                  std::vector<std::int32_t>(forces_[k].vertex.begin(), forces_[k].vertex.end()));
      put_flat(archive, name + "/force", forces_[k].force);
      save_tangents(archive, name, forces_[k]);
      const ContactSums& c = report_.contact[k];
      archive.put(name + "/sums",
                  std::vector<double>{c.force.x(), c.force.y(), c.force.z(), c.normal.x(), c.normal.y(),
                                      c.normal.z(), c.tangential.x(), c.tangential.y(), c.tangential.z(),
                                      c.moment.x(), c.moment.y(), c.moment.z(), c.transfer_force_residual,
                                      c.transfer_moment_residual, c.work, static_cast<double>(c.contacts)});
    }
  }

  void save_setup(Archive& archive) const override {
    const Archive::Scope scope(archive, "setup/");
    archive.put("top_height", setup_.top_height);
    archive.put("mean_height", setup_.mean_height);
    archive.put("floor_height", setup_.floor_height);
    archive.put("settle_wall_s", setup_.settle_wall_s);
    archive.put("grains", setup_.grains);
    archive.put("before", before_.height);
    archive.put("before_grid", std::vector<double>{before_.x0, before_.y0, before_.cell, double(before_.nx),
                                                   double(before_.ny)});
  }

  void restore(const Archive& archive) override {
    terrain_->restore(archive);
    for (std::size_t k = 0; k < forces_.size(); ++k) {
      const std::string name = "node/forces" + std::to_string(k);
      const auto& vertex = archive.get<std::int32_t>(name + "/vertex");
      forces_[k].force = get_flat<Vec3>(archive, name + "/force", vertex.size());
      forces_[k].vertex.assign(vertex.begin(), vertex.end());
      restore_tangents(archive, name, forces_[k]);
      const auto& v = archive.get<double>(name + "/sums", 16);
      report_.contact[k] = {{v[0], v[1], v[2]},
                            {v[3], v[4], v[5]},
                            {v[6], v[7], v[8]},
                            {v[9], v[10], v[11]},
                            v[12],
                            v[13],
                            v[14],
                            std::int64_t(v[15])};
    }
    report_.state = terrain_->state();
  }

 private:
  static constexpr Address kSelf{Role::terrain, 0};
  static constexpr Address kRig{Role::rig, 0};

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
    for (std::size_t k = 0; k < rims.size(); ++k) {
      const Vec3& at = rims[k];
      const double reach = kFootprintShare * cards[1 + k].tire_radius, half = 0.5 * cards[1 + k].tire_width;
      setup_.top_height.push_back(
          terrain_->top_height(at.x() - reach, at.x() + reach, at.y() - 1.5 * half, at.y() + 1.5 * half));
      const double length = scenario_.terrain.length, known = scenario_.terrain.undisturbed_height;
      setup_.mean_height.push_back(
          known >= 0.0 ? known
                       : terrain_->mean_height(0.1 * length, 0.9 * length, at.y() - half, at.y() + half));
    }
  }

  void restore_setup(const Archive& archive) {
    const Archive::Scope scope(archive, "setup/");
    setup_.top_height = archive.get<double>("top_height");
    setup_.mean_height = archive.get<double>("mean_height");
    setup_.floor_height = archive.get_double("floor_height");
    setup_.settle_wall_s = archive.get_double("settle_wall_s");
    setup_.grains = archive.get_int("grains");
    before_.height = archive.get<double>("before");
    const auto& grid = archive.get<double>("before_grid", 5);
    before_.x0 = grid[0], before_.y0 = grid[1], before_.cell = grid[2];
    before_.nx = static_cast<std::int32_t>(grid[3]), before_.ny = static_cast<std::int32_t>(grid[4]);
  }

  void write_frame(const StepHeader& header) {
    if (!frames_.due(header.step)) return;
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
  checkpoint::FrameClock frames_;
  Order due_ = Order::go_on;
};

}  // namespace

std::unique_ptr<Node> make_terrain_node(const scenario::Scenario& scenario, int threads) {
  return std::make_unique<TerrainNode>(scenario, threads);
}

}  // namespace furrow::ranks
