// A wire over MPI. Data and control travel on separate communicators; a tag is the message's kind. The wire owns what
// it sends until MPI is done with it. It takes in whatever arrives at every opportunity, so that no peer has to wait
// until this node asks for its message.
//
// Idling: a few tests for messages, then sleep. A waiting rank leaves its core to a working one, because a laptop
// usually has fewer cores than a run has ranks. A rank that sends to another on the same machine rings its doorbell,
// which ends its sleep. A waiting rank must not look for messages on its own while others want the core: each look, and
// each sched_yield(), would put it at the end of the queue for milliseconds. Messages from other machines ring no bell,
// nor do messages that move only while their sender is inside MPI. For these it sleeps in short pieces that grow with
// the wait, and may notice them one piece late.
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
  std::uint32_t rung_ = 0;  // own doorbell's count before the last look for messages
  std::deque<PendingSend> sends_, control_sends_;
  std::map<std::pair<int, int>, std::deque<Bytes>> arrived_;  // by rank and tag
  std::deque<ControlBytes> control_arrived_;
};

}  // namespace furrow
