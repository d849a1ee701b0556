// The tire's rank. Its bead follows the rim's extrapolated motion (tire/rim_trajectory.hpp). The terrain's forces of
// the last interval act over the next one, those of a prompt tire over their own (nodes/ranks/node.hpp). The rig
// receives the spindle wrench without the tire's own rigid-body inertia and weight, which it carries as added mass
// (nodes/ranks/carried_wrench.hpp), with v and ω of the bead's trajectory. Thus nothing is counted twice, and a rigid
// tire sends only its contact.
// With contact tangents the forces follow the tire's motion within a step. Their difference from the forces that the
// terrain then reports is recorded and returned (nodes/ranks/impulse_ledger.hpp).
// A prompt tire that does not follow its rim computes its contact while it moves. It moves before it states the forces.
#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "nodes/output/frames.hpp"
#include "nodes/ranks/carried_wrench.hpp"
#include "nodes/ranks/early_end.hpp"
#include "nodes/ranks/impulse_ledger.hpp"
#include "nodes/ranks/saved_forces.hpp"
#include "nodes/scenario/wheel_geometry.hpp"
#include "protocol/contact_statement.hpp"
#include "protocol/core/archive_fields.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/core/mean_turn.hpp"
#include "tire/outward.hpp"
#include "tire/reach.hpp"

namespace furrow::ranks {
namespace {

tire::TireContext tire_context(const scenario::Scenario& scenario, int index, std::function<void()> alive) {
  tire::TireContext context{
      .gravity = scenario.rig->gravity(), .ground_friction = scenario.ground_friction, .alive = std::move(alive)};
  if (const tire::TireDescription tire = scenario.tires.at(index)->describe(); tire.own_contact_in_plane)
    context.ground_profile = scenario.terrain->profile(scenario.terrain_context());
  else if (!tire.own_contact.empty())
    context.ground_heights = scenario.terrain->heights(scenario.terrain_context());
  return context;
}

class TireNode : public Node {
 public:
  TireNode(const scenario::Scenario& scenario, int index, std::function<void()> alive)
      : scenario_(scenario),
        index_(index),
        kind_(scenario.tires.at(index)->describe().kind),
        pressure_(scenario.tires.at(index)->options().pressure),
        follows_rim_(scenario.tires.at(index)->describe().follows_rim),
        tire_(scenario.tires.at(index)->make(tire_context(scenario, index, std::move(alive)))),
        reach_(tire::inflated_reach(*tire_, scenario::describe_rig(scenario).wheels.at(index).camber_angle)) {
    report_.prompt = scenario.prompt(index);
    report_.contact_tangent = scenario.tires.at(index)->options().contact_tangent;
    if (report_.contact_tangent) ledger_ = ImpulseLedger(tire_->mesh().vertex_count);
  }

  NodeCard card() const override {
    NodeCard card = common_card(scenario_, {Role::tire, index_});
    card.node_kind = kind_;
    card.substeps = scenario_.tire_substeps;
    card.tire_mass = tire_->mass_properties();
    card.tire_radius = tire_->radius();
    card.tire_width = tire_->tread_width();
    card.tire_reach = reach_;
    card.size = tire_->coordinates();
    return card;
  }

  void set_up(Transport& transport, std::span<const NodeCard>, const RunContext& context) override {
    directory_ = context.directory;
    held_ = context.held;
    frames_ = frame_clock(scenario_, context);
    // Done before anybody touches the results of the run: damaged data is refused here.
    if (context.saved) restore_forces(*context.saved, kShown, tire_->mesh().vertex_count, forces_);
    send(transport, kTerrain, SurfaceSetup{tire_->mesh(), tire_->material()});
    const auto start = receive_step<RimMotion>(transport, kRig, kPlacement);
    trajectory_ = tire::RimTrajectory(start.rim);
    tire_->place(start.rim);
    tire_->surface(motion_.surface);
    tire::require_outward(tire_->mesh(), motion_.surface.position, start.rim.position,
                          scenario_.tires[index_]->options().file.string());
    motion_.header = {kPlacement, 0.0};
    send(transport, kTerrain, motion_);
    describe_state();
    if (context.saved) {
      restore(*context.saved);
      motion_.ends_at = saved_end(*context.saved);
    }
  }

  void synchronize(Transport& transport, const StepHeader& header) override {
    report_.header = motion_.header = header;
    motion_.order = due_ = next_;
    write_frame(header);
    send(transport, kRig, report_);
    if (report_.prompt)
      send(transport, kTerrain, SurfaceMotion{header, {}, motion_.order, motion_.ends_at});
    else
      send(transport, kTerrain, motion_);
    rim_ = receive_step<RimMotion>(transport, kRig, header.step);
    next_ = rim_.order;
    const std::int64_t sent = motion_.ends_at;
    FURROW_ASSERT(sent == kNotYet || sent == rim_.ends_at, sent, rim_.ends_at);
    motion_.ends_at = rim_.ends_at;
    if (!report_.prompt) forces_ = receive_step<TerrainForces>(transport, kTerrain, header.step).forces;
  }

  void answer(Transport& transport, const StepHeader& header) override {
    if (!report_.prompt) return;
    const double duration = scenario_.run.step;
    if (const Outcome stated = tire_->state_contact(rim_.rim, duration); !stated.ok) throw failed(stated, header);
    trajectory_.extend_accelerated(rim_.rim, duration);
    SurfaceMotion end{header, {}, Order::go_on, kNotYet};
    if (follows_rim_) {
      tire_->surface_on(trajectory_.end(), end.surface);
    } else {
      forces_.clear();
      move(header);
      tire_->surface(end.surface);
    }
    std::ranges::fill(end.surface.velocity, Vec3::Zero());  // the interval ends there
    send(transport, kTerrain, end);
    if (const StatedContact* contact = tire_->stated_contact())
      send(transport, kTerrain, ContactStatement{header, *contact});
    forces_ = receive_step<TerrainForces>(transport, kTerrain, header.step).forces;
    if (follows_rim_) move(header);
    account(duration);
    send(transport, kRig, PromptWrench{header, report_.wrench});
  }

  void advance(const StepHeader& header) override {
    if (report_.prompt) return;
    trajectory_.extend(rim_.rim, scenario_.run.step);
    move(header);
    account(scenario_.run.step);
  }

  Order due() const override { return due_; }
  std::int64_t ends_at() const override { return motion_.ends_at; }
  void finish(Transport& transport, FinalReport own, bool) override { send(transport, kRig, own); }

  void save(Archive& archive) const override {
    tire_->save(archive);
    trajectory_.save(archive);
    if (report_.contact_tangent) ledger_.save(archive);
    save_fields(archive, kReport, report_);
  }

  /// The next forces come from the terrain; the frame of the checkpoint's step shows the last ones.
  void save_setup(Archive& archive) const override {
    save_fields(archive, kShown, NodalForces{forces_.vertex, forces_.force});
    save_end(archive, motion_.ends_at);
  }

  void restore(const Archive& archive) override {
    tire_->restore(archive);
    trajectory_.restore(archive);
    restore_fields(archive, kReport, report_);
    if (report_.contact_tangent) {
      ledger_.restore(archive);
      report_ledger();
    }
    tire_->surface(motion_.surface);
    describe_state();
  }

 private:
  static constexpr Address kRig{Role::rig, 0};
  static constexpr Address kTerrain{Role::terrain, 0};
  static constexpr char kReport[] = "node/report", kShown[] = "shown_forces";  // in the saved state

  void move(const StepHeader& header) {
    FURROW_ASSERT(header.step >= 0 && scenario_.tire_substeps > 0, header.step, scenario_.tire_substeps);
    const double duration = scenario_.run.step;
    if (report_.contact_tangent) {
      ledger_.settle(forces_, duration);
      ledger_.hand_back(forces_, duration);
    } else {
      forces_.tangent.clear();
    }
    if (pressure_.varies()) tire_->set_pressure(pressure_.at(header.time + 0.5 * duration));
    const Outcome outcome = tire_->advance(trajectory_, forces_, scenario_.tire_substeps);
    if (!outcome.ok) throw failed(outcome, header);
    tire_->acted(forces_);
  }

  Error failed(const Outcome& outcome, const StepHeader& header) const {
    return physics_error(outcome, to_string(Address{Role::tire, index_}), when(header));
  }

  void account(double duration) {
    const RimState &from = trajectory_.start(), &to = trajectory_.end();
    report_.spindle = tire_->spindle_wrench();
    report_.wrench = carried_wrench(report_.spindle, tire_->mass_properties(), from, to, duration, tire_->gravity());
    report_.rim_work -= report_.spindle.force.dot(to.position - from.position) +
                        report_.spindle.moment.dot(mean_turn(from.orientation, to.orientation));
    report_.spindle_impulse += duration * report_.spindle.force;
    report_.gravity_impulse += duration * tire_->mass_properties().mass * tire_->gravity();

    position_before_.swap(motion_.surface.position);
    tire_->surface(motion_.surface);
    Vec3 impulse = Vec3::Zero();
    report_.contact = {};
    const Vec3 centre = 0.5 * (from.position + to.position);
    for (std::size_t i = 0; i < forces_.vertex.size(); ++i) {
      const Vec3 &force = forces_.force[i], &before = position_before_[forces_.vertex[i]],
                 &after = motion_.surface.position[forces_.vertex[i]];
      impulse += duration * force;
      report_.contact.force += force;
      report_.contact.moment += (0.5 * (before + after) - centre).cross(force);
      report_.terrain_work += force.dot(after - before);
    }
    report_.impulse_received += impulse;
    report_.impulse_received_abs += impulse.norm();
    if (report_.prompt) report_.impulse_ahead = impulse;
    if (report_.contact_tangent) {
      ledger_.book(forces_, duration);
      report_ledger();
    }
    describe_state();
  }

  void report_ledger() {
    report_.impulse_ahead = ledger_.sum();
    report_.ledger = ledger_.settled();
    report_.ledger_largest = ledger_.largest();
  }

  void describe_state() {
    report_.diagnostics = tire_->diagnostics();
    if (const char* missing = first_missing(report_.diagnostics))
      throw physics_error("{}: its {} is not finite, or its model {} does not give it",
                          to_string(Address{Role::tire, index_}), missing, kind_);
    const tire::NamedValues figures = tire_->figures();
    report_.newton_iterations = static_cast<std::int64_t>(figures.of("newton_iterations"));
    report_.factorizations = static_cast<std::int64_t>(figures.of("factorizations"));
    report_.residual = figures.of("residual");
    const auto tread = std::span(motion_.surface.position).first(static_cast<std::size_t>(tire_->tread_vertices()));
    report_.lowest_point = std::ranges::min(tread, {}, [](const Vec3& x) { return x.z(); }).z();
    if (!std::isfinite(report_.lowest_point + report_.spindle.force.sum()))
      throw physics_error(to_string(Address{Role::tire, index_}) + ": the state is not finite");
  }

  void write_frame(const StepHeader& header) {
    if (!frames_.due(header.step)) return;
    if (held_) held_->check();
    output::write_tire_frame(directory_, index_, frames_.index(header.step), header.time, tire_->mesh(),
                             motion_.surface, forces_, tire_->strain());
  }

  scenario::Scenario scenario_;
  int index_;
  std::string kind_;
  tire::PressureSchedule pressure_;
  bool follows_rim_;
  std::unique_ptr<tire::Tire> tire_;
  double reach_;  // m
  tire::RimTrajectory trajectory_;
  RimMotion rim_;
  NodalForces forces_;
  ImpulseLedger ledger_;
  SurfaceMotion motion_;
  SpindleReport report_;
  std::vector<Vec3> position_before_;
  std::filesystem::path directory_;
  launch::HeldFolder* held_ = nullptr;
  checkpoint::FrameClock frames_;
  Order next_ = Order::go_on, due_ = Order::go_on;
};

}  // namespace

std::unique_ptr<Node> make_tire_node(const scenario::Scenario& scenario, int index, std::function<void()> alive) {
  return std::make_unique<TireNode>(scenario, index, std::move(alive));
}

}  // namespace furrow::ranks
