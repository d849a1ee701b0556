// A wire of queues between threads of one process.
#include <chrono>
#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>
#include <utility>

#include "protocol/core/assert.hpp"
#include "protocol/node_transport.hpp"

namespace furrow {
namespace {

struct Mailbox {
  std::mutex mutex;
  std::condition_variable changed;
  std::map<std::pair<int, MessageKind>, std::deque<Bytes>> data;  // by sender and kind
  std::deque<ControlBytes> control;
  std::int64_t arrivals = 0;
};

class QueueWire final : public Wire {
 public:
  QueueWire(std::shared_ptr<std::vector<Mailbox>> boxes, int self) : boxes_(std::move(boxes)), self_(self) {
    FURROW_ASSERT(boxes_ != nullptr && in_range(self_, boxes_->size()), self_);
  }

  int self() const override { return self_; }
  int node_count() const override { return static_cast<int>(boxes_->size()); }

  void send(int to, MessageKind kind, Bytes payload) override {
    deliver(to, [&](Mailbox& box) { box.data[{self_, kind}].push_back(std::move(payload)); });
  }
  void send_control(int to, Bytes payload) override {
    deliver(to, [&](Mailbox& box) { box.control.push_back({self_, std::move(payload)}); });
  }

  void progress() override {
    const std::lock_guard lock(own().mutex);
    arrivals_seen_ = own().arrivals;
  }
  std::optional<Bytes> take(int from, MessageKind kind) override {
    FURROW_ASSERT(in_range(from, boxes_->size()), from, boxes_->size());
    const std::lock_guard lock(own().mutex);
    return pop(own().data[{from, kind}]);
  }
  std::optional<ControlBytes> take_control() override {
    const std::lock_guard lock(own().mutex);
    return pop(own().control);
  }
  int unsent_to() const override { return -1; }

  void idle(int, double) override {
    std::unique_lock lock(own().mutex);
    own().changed.wait_for(lock, std::chrono::milliseconds(20), [&] { return own().arrivals != arrivals_seen_; });
  }
  void expect_losses(double, int) noexcept override {}

 private:
  Mailbox& own() { return (*boxes_)[self_]; }

  template <class Put>
  void deliver(int to, const Put& put) {
    FURROW_ASSERT(in_range(to, boxes_->size()), to, boxes_->size());
    Mailbox& box = (*boxes_)[to];
    const std::lock_guard lock(box.mutex);
    put(box);
    ++box.arrivals;
    box.changed.notify_all();
  }

  std::shared_ptr<std::vector<Mailbox>> boxes_;
  int self_;
  std::int64_t arrivals_seen_ = 0;
};

}  // namespace

std::vector<std::unique_ptr<Transport>> make_in_process_transports(int tire_count, int terrain_ranks) {
  FURROW_ASSERT(tire_count >= 0 && terrain_ranks > 0, tire_count, terrain_ranks);
  const int nodes = 1 + tire_count + terrain_ranks;
  auto boxes = std::make_shared<std::vector<Mailbox>>(nodes);
  std::vector<HostNode> host;
  for (int i = 0; i < nodes; ++i) host.push_back({address_of(i, tire_count), allowed_cores(), false});
  std::vector<std::unique_ptr<Transport>> transports;
  for (int i = 0; i < nodes; ++i) {
    std::vector<HostNode> seen = host;
    seen[i].self = true;
    transports.push_back(
        std::make_unique<NodeTransport>(std::make_unique<QueueWire>(boxes, i), tire_count, std::move(seen)));
  }
  return transports;
}

}  // namespace furrow
