#include "nodes/run_node.hpp"

#include <ctime>

#include "nodes/node.hpp"
#include "nodes/profile.hpp"
#include "protocol/hash.hpp"

namespace furrow {
namespace {

/// CPU time of all threads of this process, s; in-process tests share it.
double cpu_s() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace

std::uint64_t state_hash(const Node& node) {
  Archive archive;
  node.save(archive);
  Hash hash;
  for (const auto& [name, values] : archive.arrays()) {
    hash.add(name);
    std::visit([&](const auto& v) { hash.add(v.data(), v.size() * sizeof(v[0])); }, values);
  }
  return hash.value();
}

std::int64_t run_steps(Node& node, Transport& transport, double step, std::int64_t from, std::int64_t to,
                       StepProfile* profile) {
  for (std::int64_t n = from; n < to; ++n) {
    const StepHeader header{n, static_cast<double>(n) * step};
    if (profile) profile->begin(n);
    node.synchronize(transport, header);
    transport.flush();
    if (profile) profile->exchanged(n);
    if (node.stopped()) return n;
    node.advance(header);
    if (profile) profile->advanced(n);
  }
  return to;
}

ExitCode run_node(const Scenario& scenario, Transport& transport, const RunContext& context) {
  try {
    transport.set_peer_timeout(scenario.run.peer_timeout);
    const std::unique_ptr<Node> node = make_node(scenario, transport.self(), context.threads);
    NodeCard card = node->card();
    card.threads = context.threads;
    const std::vector<NodeCard> cards = handshake(transport, card);
    node->set_up(transport, cards, context);

    const std::int64_t steps = scenario.run.steps();
    StepProfile profile(context.profile ? steps : 0);
    const double wall_start = machine_clock(), cpu_start = cpu_s(),
                 waited_start = transport.wait_clock().waited_s;
    run_steps(*node, transport, scenario.run.step, 0, steps, &profile);
    if (!node->stopped()) {
      node->synchronize(transport, {steps, static_cast<double>(steps) * scenario.run.step});
      transport.flush();
    }
    FinalReport own;
    own.self = transport.self();
    own.wait_s = transport.wait_clock().waited_s - waited_start;
    own.compute_s = machine_clock() - wall_start - own.wait_s;
    own.cpu_s = cpu_s() - cpu_start;
    own.threads = context.threads;
    own.profile = profile.times();
    own.state_hash = state_hash(*node);
    node->finish(transport, own);
    return node->stopped() ? ExitCode::stopped : ExitCode::done;
  } catch (const PeerFailure&) {
    throw;
  } catch (const Error& error) {
    transport.announce_failure(error.code(), error.what());
    throw;
  } catch (const std::exception& error) {
    transport.announce_failure(ExitCode::physics, error.what());
    throw;
  }
}

}  // namespace furrow
