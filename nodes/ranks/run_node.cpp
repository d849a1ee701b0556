#include "nodes/ranks/run_node.hpp"

#include <algorithm>
#include <ctime>
#include <new>

#include "nodes/output/profile.hpp"
#include "nodes/ranks/checkpoint_writer.hpp"
#include "nodes/ranks/node.hpp"
#include "nodes/scenario/memory_check.hpp"
#include "protocol/core/archive_hash.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/core/clock.hpp"
#include "protocol/files/archive_file.hpp"
#include "protocol/files/fault_point.hpp"
#include "protocol/transport_group.hpp"

namespace furrow::ranks {
namespace {

/// Processor time of all threads of this process, s; in-process tests share it.
double cpu_s() { return processor_time(CLOCK_PROCESS_CPUTIME_ID); }

}  // namespace

std::uint64_t state_hash(const Node& node) {
  Archive archive;
  node.save(archive);
  return archive_hash(archive).value();
}

std::int64_t run_steps(Node& node, Transport& transport, double step, std::int64_t from, std::int64_t to,
                       output::StepProfile* profile, const std::function<void(std::int64_t)>& checkpoint) {
  FURROW_ASSERT(step > 0.0, step);
  FURROW_ASSERT(from >= 0 && from <= to, from, to);
  for (std::int64_t n = from; n < std::min(to, node.ends_at()); ++n) {
    const StepHeader header{n, static_cast<double>(n) * step};
    if (profile) profile->begin(n);
    node.synchronize(transport, header);
    transport.flush();
    if (profile) profile->exchanged(n);
    fault_point("step");
    node.answer(transport, header);
    transport.flush();
    node.advance(header);
    if (profile) profile->advanced(n);
    if (node.due() != Order::go_on && checkpoint) checkpoint(n + 1);
    if (node.due() == Order::stop) return n + 1;
  }
  return std::min(to, node.ends_at());
}

namespace {

/// The node's stepping loop and its cost.
class RunLoop {
 public:
  RunLoop(const scenario::Scenario& scenario, Transport& transport, const RunContext& context)
      : scenario_(scenario), transport_(transport), context_(context) {}

  /// Writes the available results after a failure, except one of the user's input or a stop.
  void fail(ExitCode code, const std::string& text) noexcept {
    if (node_ && code != ExitCode::bad_input && code != ExitCode::stopped) node_->fail(code, text);
  }

  /// The reason why the final checkpoint could not be written; empty if it was.
  const std::string& lost() const { return lost_; }

  ExitCode run() {
    transport_.set_peer_timeout(scenario_.run.peer_timeout);
    Archive saved;
    if (context_.resume) {
      saved = read_archive(context_.resume->folder / checkpoint::part_name(transport_.self()));
      context_.saved = &saved;
      cost_before_ = restore_cost(saved);
      from_ = context_.resume->manifest.step;
    }
    node_ = make_node(
        scenario_, transport_.self(), context_.threads, [this] { show_life(); }, make_terrain_group(transport_));
    NodeCard card = node_->card();
    card.threads = context_.threads;
    card.from_step = from_;
    const std::vector<NodeCard> cards = handshake(transport_, card);
    node_->set_up(transport_, cards, context_);
    context_.saved = nullptr;
    saved = {};
    return step(cards);
  }

 private:
  /// Shows that this node lives while it prepares itself, and notices if another node is lost.
  void show_life() {
    transport_.heartbeat();
    transport_.check_peers();
    if (context_.stop_requested && context_.stop_requested())
      throw Error(ExitCode::stopped, "stopped by a signal while the tire was being inflated");
  }

  ExitCode step(const std::vector<NodeCard>& cards) {
    const std::int64_t steps = scenario_.run.steps();
    profile_ = output::StepProfile(context_.profile ? steps : 0);
    wall_start_ = wall_clock(), cpu_start_ = cpu_s(), waited_start_ = transport_.wait_clock().waited_s;
    CheckpointWriter checkpoints(scenario_, *node_, transport_, context_, cards, [this] { return cost(); });
    const auto at_end = scenario_.checkpoint.at_end ? CheckpointNeed::last : CheckpointNeed::wished;
    const std::int64_t at =
        run_steps(*node_, transport_, scenario_.run.step, from_, steps, &profile_, [&](std::int64_t n) {
          const bool complete = n >= std::min(steps, node_->ends_at());
          checkpoints.write(n, complete                      ? at_end
                               : node_->due() == Order::stop ? CheckpointNeed::needed
                                                             : CheckpointNeed::wished);
        });
    const bool stopped = at < std::min(steps, node_->ends_at());
    if (!stopped) {
      if (scenario_.checkpoint.at_end && checkpoints.last_step() != at) checkpoints.write(at, at_end);
      node_->synchronize(transport_, {at, static_cast<double>(at) * scenario_.run.step});
      transport_.flush();
    }
    FinalReport own;
    own.self = transport_.self();
    const NodeCost used = cost();
    own.wait_s = used.wait_s;
    own.compute_s = used.compute_s;
    own.communicate_s = used.communicate_s;
    own.cpu_s = used.cpu_s;
    own.threads = context_.threads;
    own.profile = profile_.times();
    own.state_hash = state_hash(*node_);
    fault_point("results");
    node_->finish(transport_, own, stopped);
    fault_point("done");
    lost_ = checkpoints.lost();
    return stopped ? ExitCode::stopped : ExitCode::done;
  }

  NodeCost cost() const {
    const double wait = transport_.wait_clock().waited_s - waited_start_;
    // Nearly all waiting is for messages; the short waits of checkpoints are not included.
    const double communicate = std::max(0.0, profile_.exchanging() - wait);
    return {cost_before_.cpu_s + cpu_s() - cpu_start_,
            cost_before_.compute_s + wall_clock() - wall_start_ - wait - communicate,
            cost_before_.communicate_s + communicate, cost_before_.wait_s + wait};
  }

  const scenario::Scenario& scenario_;
  Transport& transport_;
  RunContext context_;
  std::unique_ptr<Node> node_;
  NodeCost cost_before_;
  std::string lost_;
  output::StepProfile profile_{0};
  std::int64_t from_ = 0;
  double wall_start_ = 0.0, cpu_start_ = 0.0, waited_start_ = 0.0;
};

}  // namespace

ExitCode run_node(const scenario::Scenario& scenario, Transport& transport, const RunContext& context) {
  RunLoop loop(scenario, transport, context);
  ExitCode code = ExitCode::done;
  try {
    code = loop.run();
  } catch (const PeerFailure& failure) {
    loop.fail(failure.code(), failure.what());
    throw;
  } catch (const Error& error) {
    transport.announce_failure(error.code(), error.what());
    loop.fail(error.code(), error.what());
    throw;
  } catch (const std::bad_alloc&) {
    const Error error = scenario::out_of_memory(scenario.memory.all);
    transport.announce_failure(error.code(), error.what());
    throw error;
  } catch (const std::exception& unexpected) {
    const Error error = fault_error(unexpected.what());
    transport.announce_failure(error.code(), error.what());
    loop.fail(error.code(), error.what());
    throw error;
  }
  // The run itself has not failed: its results are complete, and the other ranks need not be informed.
  if (!loop.lost().empty())
    throw Error(ExitCode::io, loop.lost() + "; all results are written, but the run cannot be continued from its end");
  return code;
}

}  // namespace furrow::ranks
