// Queues between threads of one process, with the failure and time-out semantics of the MPI transport.
#include <chrono>
#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <tuple>

#include "protocol/peer_clock.hpp"
#include "protocol/transport.hpp"

namespace furrow {
namespace {

struct Failure {
  ExitCode code;
  Address who;
  std::string text;
};

/// What all transports of one run share.
struct Exchange {
  std::mutex mutex;
  std::condition_variable changed;
  std::map<std::tuple<int, int, MessageKind>, std::deque<std::vector<std::byte>>> queues;  // from, to, kind
  std::vector<std::int64_t> heartbeats;  // per node, counted
  std::optional<Failure> failure;
};

class InProcessTransport final : public Transport {
 public:
  InProcessTransport(std::shared_ptr<Exchange> exchange, Address self, int tire_count)
      : exchange_(std::move(exchange)), self_(self), tire_count_(tire_count) {}

  Address self() const override { return self_; }
  int tire_count() const override { return tire_count_; }

  void send(Address to, MessageKind kind, std::vector<std::byte> payload) override {
    const std::lock_guard lock(exchange_->mutex);
    exchange_->queues[{number(self_), number(to), kind}].push_back(std::move(payload));
    exchange_->changed.notify_all();
  }

  std::vector<std::byte> receive(Address from, MessageKind kind) override {
    std::unique_lock lock(exchange_->mutex);
    auto& queue = exchange_->queues[{number(from), number(self_), kind}];
    PeerClock clock(timeout_);
    std::int64_t heard = exchange_->heartbeats[number(from)];
    while (queue.empty()) {
      throw_failure();
      exchange_->changed.wait_for(lock, std::chrono::milliseconds(20));
      if (exchange_->heartbeats[number(from)] != heard) {
        heard = exchange_->heartbeats[number(from)];
        clock.heard();
      }
      if (clock.expired()) throw lost_peer(self_, from, kind, timeout_);
    }
    clock_.waited_s += clock.total();
    std::vector<std::byte> payload = std::move(queue.front());
    queue.pop_front();
    return payload;
  }

  void heartbeat() override {
    const std::lock_guard lock(exchange_->mutex);
    ++exchange_->heartbeats[number(self_)];
  }

  void announce_failure(ExitCode code, const std::string& text) noexcept override {
    const std::lock_guard lock(exchange_->mutex);
    if (!exchange_->failure) exchange_->failure = Failure{code, self_, text};
    exchange_->changed.notify_all();
  }

  void check_peers() override {
    const std::lock_guard lock(exchange_->mutex);
    throw_failure();
  }

  const WaitClock& wait_clock() const override { return clock_; }
  void set_peer_timeout(double seconds) override { timeout_ = seconds; }

 private:
  int number(Address node) const {
    return node.role == Role::rig ? 0 : node.role == Role::tire ? 1 + node.index : 1 + tire_count_;
  }
  void throw_failure() const {
    if (exchange_->failure && exchange_->failure->who != self_)
      throw PeerFailure(exchange_->failure->code, exchange_->failure->who, exchange_->failure->text);
  }

  std::shared_ptr<Exchange> exchange_;
  Address self_;
  int tire_count_;
  double timeout_ = 60.0;
  WaitClock clock_;
};

}  // namespace

std::vector<std::unique_ptr<Transport>> make_in_process_transports(int tire_count) {
  auto exchange = std::make_shared<Exchange>();
  exchange->heartbeats.assign(tire_count + 2, 0);
  std::vector<std::unique_ptr<Transport>> transports;
  transports.push_back(std::make_unique<InProcessTransport>(exchange, Address{Role::rig, 0}, tire_count));
  for (int k = 0; k < tire_count; ++k)
    transports.push_back(std::make_unique<InProcessTransport>(exchange, Address{Role::tire, k}, tire_count));
  transports.push_back(std::make_unique<InProcessTransport>(exchange, Address{Role::terrain, 0}, tire_count));
  return transports;
}

}  // namespace furrow
