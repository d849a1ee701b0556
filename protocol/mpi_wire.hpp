// A wire over MPI. Data and control travel on communicators of their own; a tag is the message's kind. The wire owns
// what it sends until MPI is done with it, and takes in whatever arrives at every opportunity, so that no peer waits
// for this node to ask for just its message.
//
// Idling: a few tests for what is about to come, then sleep. A waiting rank leaves its core to a working one (more
// ranks than cores is the usual case on a laptop). Whoever sends to a rank of the same machine rings its doorbell,
// which ends its sleep. It must not look around on its own in between where others want the core: each time it would
// stand at the end of their queue, for milliseconds; and sched_yield() is the same. Messages from other machines, and
// those that move only while their sender is inside MPI, ring no bell: for them it sleeps in short pieces that grow
// with the wait, and may notice them one piece late.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <utility>

#include "protocol/mpi_doorbells.hpp"
#include "protocol/mpi_session.hpp"
#include "protocol/wire.hpp"

namespace furrow {

class MpiWire final : public Wire {
 public:
  /// The nodes are the ranks of the world; those of one role share a communicator.
  MpiWire(MpiSession& session, int role);
  ~MpiWire() override;

  int self() const override { return self_; }
  int node_count() const override { return nodes_; }
  std::optional<int> role_communicator() const override { return MPI_Comm_c2f(role_.get()); }
  void send(int to, MessageKind kind, Bytes payload) override;
  void send_control(int to, Bytes payload) override;
  void progress() override;
  std::optional<Bytes> take(int from, MessageKind kind) override;
  std::optional<ControlBytes> take_control() override;
  int unsent_to() const override;
  void idle(int polls, double waited) override;
  void expect_losses(double patience, int exit_code) noexcept override;

 private:
  struct PendingSend {
    int to = 0;
    Bytes payload;
    MPI_Request request = MPI_REQUEST_NULL;
  };
  void post(std::deque<PendingSend>& sends, const Communicator& comm, int to, int tag, Bytes payload);
  static void complete(std::deque<PendingSend>& sends);
  void drain(double longest);
  bool every_message_rings() const;

  MpiSession& session_;
  Communicator data_, control_, role_;
  MpiDoorbells doorbells_;
  int self_, nodes_;
  std::uint32_t rung_ = 0;  // own doorbell's count before the last look around
  std::deque<PendingSend> sends_, control_sends_;
  std::map<std::pair<int, int>, std::deque<Bytes>> arrived_;  // by rank and tag
  std::deque<ControlBytes> control_arrived_;
};

}  // namespace furrow
