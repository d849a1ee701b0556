// One rank's part of a co-simulation: rig, tire or terrain. The run loop drives all kinds alike:
//
//   set_up;  for n = 0 … N:  synchronize(n);  if n < N: answer; advance
//
// Forces come one step late: so rig, tires and terrain compute at the same time. A tire that follows its rim has
// nothing to compute, and grounds given by formulas have little. Between those two forces are prompt: in answer() the
// tire moves with the rim of t_n, the terrain gives it the forces of that interval, and the rig gets their wrench.
//
// synchronize sends everything before it receives anything, so that no order of ranks can deadlock. The rig orders
// checkpoints and stops: at t_n it informs the tires, at t_{n+1} they inform the terrain, and all save at t_{n+2},
// before they synchronize there. Between the steps nothing is in flight, so that the nodes' states are all there is. In
// the same way it announces the step at which a run is complete before its planned end; nodes that know it save it.
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

  /// Exchanges what is said once; `cards` in the order rig, tires, terrain. A run that is continued comes out of it in
  /// the state of context.saved.
  virtual void set_up(Transport& transport, std::span<const NodeCard> cards, const RunContext& context) = 0;

  virtual void synchronize(Transport& transport, const StepHeader& header) = 0;

  /// Exchanges and computes what acts within the step that begins at t_n: the forces of prompt tires.
  virtual void answer(Transport&, const StepHeader&) {}

  /// Advances this node by one communication step, from t_n.
  virtual void advance(const StepHeader& header) = 0;

  /// What falls due once the interval after the synchronization just done has been advanced.
  virtual Order due() const = 0;

  /// The step at which the run is complete before its planned end, as far as this node knows.
  virtual std::int64_t ends_at() const { return kNotYet; }

  /// Sends (tire, terrain) or gathers and writes (rig) the results. `stopped`: before the planned end.
  virtual void finish(Transport& transport, FinalReport own, bool stopped) = 0;

  /// The run has failed, here or elsewhere: writes what there is of its results (rig). Does what it can.
  virtual void fail(ExitCode, const std::string&) noexcept {}

  virtual void save(Archive& archive) const = 0;
  virtual void restore(const Archive& archive) = 0;

  /// What is no state but must be known to continue: kept in checkpoints beside save().
  virtual void save_setup(Archive&) const {}
  /// The rig's: flushes the tables to the disk and says where they stand.
  virtual std::vector<checkpoint::SeriesMark> mark_series() { return {}; }
};

std::unique_ptr<Node> make_rig_node(const scenario::Scenario& scenario);
std::unique_ptr<Node> make_tire_node(const scenario::Scenario& scenario, int index, std::function<void()> alive);
/// @param group of a terrain of several ranks, whose leader this is; null: it is the only one
std::unique_ptr<Node> make_terrain_node(const scenario::Scenario& scenario, int threads,
                                        std::shared_ptr<RankGroup> group = nullptr);
/// A rank of a terrain that is not its leader, and follows it.
std::unique_ptr<Node> make_terrain_follower(const scenario::Scenario& scenario, int threads,
                                            std::shared_ptr<RankGroup> group);

/// The node that `self` is in this scenario.
/// @param alive  called now and then while it makes itself ready; may throw to stop
/// @param group  of a terrain of several ranks
std::unique_ptr<Node> make_node(const scenario::Scenario& scenario, Address self, int threads,
                                std::function<void()> alive = {}, std::shared_ptr<RankGroup> group = nullptr);

/// Synchronizes and advances for n = from … to − 1; calls `checkpoint(n)` when one falls due. Ends early when ordered
/// to, and where the run is complete.
/// @returns the step it stands at, not yet synchronized there
std::int64_t run_steps(Node& node, Transport& transport, double step, std::int64_t from, std::int64_t to,
                       output::StepProfile* profile = nullptr,
                       const std::function<void(std::int64_t)>& checkpoint = {});

/// Hash of everything that save() holds.
std::uint64_t state_hash(const Node& node);

/// What all cards of a run share.
NodeCard common_card(const scenario::Scenario& scenario, Address self);

/// Frames of the segment that begins now.
checkpoint::FrameClock frame_clock(const scenario::Scenario& scenario, const RunContext& context);

/// " at t = 0.1 s, step 7": where a step that failed began, for physics_error(outcome, who, where).
std::string when(const StepHeader& header);

/// Step number of the messages by which rims and tires are placed, before synchronization 0.
inline constexpr std::int64_t kPlacement = -1;

}  // namespace furrow::ranks
