// A wire over MPI. Data and control travel on communicators of their own; a tag is the message's kind. The wire owns
// what it sends until MPI is done with it, and takes in whatever arrives at every opportunity, so that no peer waits
// for this node to ask for just its message.
//
// Idling: a few tests with yields, for what is about to come, then sleeps that grow with the wait. A waiting rank
// leaves its core to a working one (more ranks than cores is the usual case on a laptop). It may notice a message one
// sleep late, which costs the run nothing unless that rank is the slowest one, and that one hardly waits.
#pragma once

#include <deque>
#include <map>
#include <utility>

#include "protocol/mpi_session.hpp"
#include "protocol/wire.hpp"

namespace furrow {

class MpiWire final : public Wire {
 public:
  /// The nodes are the ranks of the world; those of one role share a communicator.
  MpiWire(MpiSession& session, int role);
  ~MpiWire() override;

  const Communicator& role() const { return role_; }

  int self() const override { return self_; }
  int node_count() const override { return nodes_; }
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
  static void post(std::deque<PendingSend>& sends, const Communicator& comm, int to, int tag, Bytes payload);
  static void complete(std::deque<PendingSend>& sends);
  void drain(double longest);

  MpiSession& session_;
  Communicator data_, control_, role_;
  int self_, nodes_;
  std::deque<PendingSend> sends_, control_sends_;
  std::map<std::pair<int, int>, std::deque<Bytes>> arrived_;  // by rank and tag
  std::deque<ControlBytes> control_arrived_;
};

}  // namespace furrow
