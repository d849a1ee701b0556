#include "protocol/node_transport.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "protocol/core/assert.hpp"
#include "protocol/peer_clock.hpp"

namespace furrow {
namespace {

constexpr double kWaitWorthTelling = 1.0;  // s; a quarter of the time-out if that is shorter

/// Counts a wait, and reports its end to the others, however it ends.
class Wait {
 public:
  Wait(PeerWatch& watch, WaitClock& clock, double timeout) : watch_(watch), clock_(clock), time_(timeout) {
    FURROW_ASSERT(timeout > 0.0, timeout);
  }
  ~Wait() {
    clock_.waited_s += time_.total();
    try {
      watch_.end_wait();
    } catch (...) {
      // Out of memory: the others keep their old note of whom this node waits for.
    }
  }
  Wait(const Wait&) = delete;
  Wait& operator=(const Wait&) = delete;
  PeerClock& time() { return time_; }

 private:
  PeerWatch& watch_;
  WaitClock& clock_;
  PeerClock time_;
};

}  // namespace

NodeTransport::NodeTransport(std::unique_ptr<Wire> wire, int tire_count, std::vector<HostNode> host_nodes)
    : wire_(std::move(wire)), tire_count_(tire_count), host_nodes_(std::move(host_nodes)), watch_(*wire_, tire_count) {
  FURROW_ASSERT(tire_count >= 0 && wire_->node_count() >= tire_count + 2, tire_count, wire_->node_count());
}

int NodeTransport::number(Address node) const {
  switch (node.role) {
    case Role::rig:
      return 0;
    case Role::tire:
      if (node.index < 0 || node.index >= tire_count_) break;
      return 1 + node.index;
    case Role::terrain:
      if (node.index < 0 || node.index >= terrain_ranks()) break;
      return 1 + tire_count_ + node.index;
  }
  throw Error(ExitCode::rank_lost, to_string(self()) + " addressed " + to_string(node) + ", which does not exist");
}

void NodeTransport::send(Address to, MessageKind kind, std::vector<std::byte> payload) {
  wire_->send(number(to), kind, std::move(payload));
}

/// Waits for `peer()`, a node number that may change meanwhile, until ready() returns true.
template <class Ready, class Peer>
void NodeTransport::wait_until(const Ready& ready, const Peer& peer, const std::string& what) {
  Wait wait(watch_, clock_, timeout_);  // before anything else: even a look may take long if cores are scarce
  check_peers();
  if (ready()) return;
  const double worth_telling = std::min(kWaitWorthTelling, 0.25 * timeout_);
  int from = -1;
  std::int64_t heard = 0;
  for (int polls = 0;; ++polls) {
    if (peer() != from) {
      from = peer();
      heard = watch_.heard(from);
      watch_.begin_wait(from);
    }
    wire_->idle(polls, wait.time().total());
    check_peers();
    if (ready()) return;
    if (watch_.heard(from) != heard) {
      heard = watch_.heard(from);
      wait.time().heard();
    }
    if (wait.time().expired()) throw watch_.lost(from, what, timeout_);
    if (wait.time().silent() > worth_telling) watch_.tell_wait();
  }
}

std::vector<std::byte> NodeTransport::receive(Address from, MessageKind kind) {
  const int source = number(from);
  std::optional<Bytes> payload;
  wait_until([&] { return (payload = wire_->take(source, kind)).has_value(); }, [&] { return source; },
             to_string(kind));
  return std::move(*payload);
}

void NodeTransport::flush() {
  int to = -1;
  wait_until([&] { return (to = wire_->unsent_to()) < 0; }, [&] { return to; }, "to take what was sent to it");
}

void NodeTransport::heartbeat() {
  watch_.heartbeat();
  wire_->progress();
}

void NodeTransport::announce_failure(ExitCode code, const std::string& text) noexcept {
  try {
    watch_.announce_failure(code, text);
    wire_->expect_losses(timeout_, static_cast<int>(code));
  } catch (...) {
    // Out of memory while failing: the others notice the silence.
  }
}

void NodeTransport::check_peers() {
  wire_->progress();
  try {
    watch_.listen();
  } catch (const PeerFailure& failure) {
    wire_->expect_losses(timeout_, static_cast<int>(failure.code()));
    throw;
  }
}

}  // namespace furrow
