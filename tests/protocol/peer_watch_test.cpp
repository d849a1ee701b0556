// The node named in the error when a node does not answer and messages arrive in an unfavourable order.
#include <deque>
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "protocol/peer_watch.hpp"
#include "protocol/wire.hpp"

namespace furrow::peer_watch_test {
namespace {

using Mail = std::vector<std::deque<ControlBytes>>;  // of each node

/// Control messages only; the test delivers them by hand.
class HandWire : public Wire {
 public:
  HandWire(int self, std::vector<Mail>& sent, Mail& arrived) : self_(self), sent_(sent), arrived_(arrived) {}
  int self() const override { return self_; }
  int node_count() const override { return static_cast<int>(arrived_.size()); }
  void send(int, MessageKind, Bytes) override {}
  void send_control(int to, Bytes payload) override { sent_[self_][to].push_back({self_, std::move(payload)}); }
  void progress() override {}
  std::optional<Bytes> take(int, MessageKind) override { return std::nullopt; }
  std::optional<ControlBytes> take_control() override {
    auto& mail = arrived_[self_];
    if (mail.empty()) return std::nullopt;
    ControlBytes first = std::move(mail.front());
    mail.pop_front();
    return first;
  }
  int unsent_to() const override { return -1; }
  void idle(int, double) override {}
  void expect_losses(double, int) noexcept override {}

 private:
  int self_;
  std::vector<Mail>& sent_;
  Mail& arrived_;
};

constexpr int kRig = 0, kTire0 = 1, kTire1 = 2, kTerrain = 3, kNodes = 4;

class PeerWatches : public ::testing::Test {
 protected:
  PeerWatches() {
    for (int node = 0; node < kNodes; ++node) {
      wires_.push_back(std::make_unique<HandWire>(node, sent_, arrived_));
      watches_.push_back(std::make_unique<PeerWatch>(*wires_.back(), 2));
    }
  }
  PeerWatch& watch(int node) { return *watches_[node]; }
  void deliver(int from, int to) {
    auto& mail = sent_[from][to];
    while (!mail.empty()) {
      arrived_[to].push_back(std::move(mail.front()));
      mail.pop_front();
    }
  }
  void waits(int node, int target) {
    watch(node).begin_wait(target);
    watch(node).tell_wait();
  }

 private:
  std::vector<Mail> sent_ = std::vector<Mail>(kNodes, Mail(kNodes));
  Mail arrived_ = Mail(kNodes);
  std::vector<std::unique_ptr<HandWire>> wires_;
  std::vector<std::unique_ptr<PeerWatch>> watches_;
};

// Both tires wait for the silent rig, the terrain waits for tire 0. Tire 1 times out; tire 0 is informed and ends
// before the terrain. The terrain must still have the information that tire 0 waited for the rig.
TEST_F(PeerWatches, WhoLeavesBecauseOfAFailureDoesNotHideWhomItWaitedFor) {
  waits(kTire0, kRig);
  waits(kTerrain, kTire0);
  watch(kTire1).begin_wait(kRig);
  const Error lost = watch(kTire1).lost(kRig, "spindle state", 5.0);
  watch(kTire1).end_wait();
  watch(kTire1).announce_failure(lost.code(), lost.what());
  deliver(kTire1, kTire0);
  EXPECT_THROW(watch(kTire0).listen(), PeerFailure);
  watch(kTire0).end_wait();

  deliver(kTire0, kTerrain);
  watch(kTerrain).listen();
  EXPECT_STREQ(watch(kTerrain).lost(kTire0, "surface motion", 5.0).what(),
               "terrain waited 5 s for tire 0 (surface motion), which waits for rig: rig does not answer; raise "
               "run.peer_timeout if it is only slow");
}

TEST_F(PeerWatches, WhoseWaitEndsWellIsNamedItself) {
  waits(kTire0, kRig);
  watch(kTire0).end_wait();
  deliver(kTire0, kTerrain);
  watch(kTerrain).listen();
  EXPECT_STREQ(watch(kTerrain).lost(kTire0, "surface motion", 5.0).what(),
               "terrain waited 5 s for tire 0 (surface motion): tire 0 does not answer; raise run.peer_timeout if it "
               "is only slow");
}

}  // namespace
}  // namespace furrow::peer_watch_test
