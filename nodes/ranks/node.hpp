// One rank's part of a co-simulation: rig, tire or terrain. The run loop drives all kinds in the same way:
//
//   set_up;  for n = 0 … N:  synchronize(n);  if n < N: answer; advance
//
// Forces act one step late, so that rig, tires and terrain compute at the same time. A tire that only follows its rim
// has nothing to compute, and grounds given by formulas have little. Between such a tire and such a ground, forces are
// prompt. In answer() the tire moves with the rim of t_n, the terrain returns the forces of that interval, and the rig
// gets their wrench. A tire that states its contact is prompt as well.
//
// synchronize sends everything before it receives anything, so that no order of ranks can deadlock. The rig orders
// checkpoints and stops. At t_n it informs the tires, at t_{n+1} they inform the terrain, and all save at t_{n+2},
// before they synchronize there. Between the steps no message is in flight, so the nodes' states are complete. In the
// same way the rig announces the step at which a run is complete before its planned end; nodes that have received this
// step save it.
#pragma once

#include <memory>
#include <span>

#include "nodes/checkpoint/frame_clock.hpp"
#include "nodes/checkpoint/series_mark.hpp"
#include "nodes/output/profile.hpp"
#include "nodes/ranks/run_context.hpp"
#include "nodes/scenario/scenario.hpp"
#include "protocol/core/archive.hpp"
#include "protocol/core/rank_group.hpp"
#include "protocol/transport.hpp"

namespace furrow::ranks {

class Node {
 public:
  virtual ~Node() = default;

  virtual NodeCard card() const = 0;

  /// Exchanges messages that are sent once; `cards` in the order rig, tires, terrain. Afterwards, a run that is
  /// continued is in the state of context.saved.
  virtual void set_up(Transport& transport, std::span<const NodeCard> cards, const RunContext& context) = 0;

  virtual void synchronize(Transport& transport, const StepHeader& header) = 0;

  /// Exchanges and computes the forces of prompt tires, which act within the step that begins at t_n.
  virtual void answer(Transport&, const StepHeader&) {}

  /// Advances this node by one communication step, from t_n.
  virtual void advance(const StepHeader& header) = 0;

  /// The order that is due after the interval that follows the last synchronization.
  virtual Order due() const = 0;

  /// The step at which the run is complete before its planned end, if this node has received it.
  virtual std::int64_t ends_at() const { return kNotYet; }

  /// Sends (tire, terrain) or gathers and writes (rig) the results. `stopped`: before the planned end.
  virtual void finish(Transport& transport, FinalReport own, bool stopped) = 0;

  /// Writes the available results of a run that has failed, here or elsewhere (rig); ignores further errors.
  virtual void fail(ExitCode, const std::string&) noexcept {}

  virtual void save(Archive& archive) const = 0;
  virtual void restore(const Archive& archive) = 0;

  /// Saves data needed to continue that is not part of the state: kept in checkpoints next to save().
  virtual void save_setup(Archive&) const {}
  /// For the rig: flushes the tables to the disk and returns their marks.
  virtual std::vector<checkpoint::SeriesMark> mark_series() { return {}; }
};

std::unique_ptr<Node> make_rig_node(const scenario::Scenario& scenario);
std::unique_ptr<Node> make_tire_node(const scenario::Scenario& scenario, int index, std::function<void()> alive);
/// @param group of a terrain with several ranks, of which this is the leader; null: the only rank
std::unique_ptr<Node> make_terrain_node(const scenario::Scenario& scenario, int threads,
                                        std::shared_ptr<RankGroup> group = nullptr);
std::unique_ptr<Node> make_terrain_follower(const scenario::Scenario& scenario, int threads,
                                            std::shared_ptr<RankGroup> group);

/// Makes the node of `self` in this scenario.
/// @param alive  called now and then during the preparation; may throw to stop
/// @param group  of a terrain of several ranks
std::unique_ptr<Node> make_node(const scenario::Scenario& scenario, Address self, int threads,
                                std::function<void()> alive = {}, std::shared_ptr<RankGroup> group = nullptr);

/// Synchronizes and advances for n = from … to − 1; calls `checkpoint(n)` when a checkpoint is due. Ends early if
/// ordered, or if the run is complete.
/// @returns the step that it has reached, not yet synchronized there
std::int64_t run_steps(Node& node, Transport& transport, double step, std::int64_t from, std::int64_t to,
                       output::StepProfile* profile = nullptr,
                       const std::function<void(std::int64_t)>& checkpoint = {});

/// Hash of everything in save().
std::uint64_t state_hash(const Node& node);

NodeCard common_card(const scenario::Scenario& scenario, Address self);

checkpoint::FrameClock frame_clock(const scenario::Scenario& scenario, const RunContext& context);

/// " at t = 0.1 s, step 7": the beginning of a failed step, for physics_error(outcome, who, where).
std::string when(const StepHeader& header);

/// Step number of the messages that place rims and tires, before synchronization 0.
inline constexpr std::int64_t kPlacement = -1;

}  // namespace furrow::ranks
