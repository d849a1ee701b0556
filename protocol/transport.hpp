// Carries messages between the nodes of a run. Two implementations: MPI, and queues in one process for tests.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "protocol/core/error.hpp"
#include "protocol/host.hpp"
#include "protocol/messages.hpp"

namespace furrow {

/// Thrown by any transport call after another node failed or was lost. The failing node has already informed the user,
/// so the code that catches this ends with `code` and prints nothing.
class PeerFailure : public Error {
 public:
  PeerFailure(ExitCode code, Address who, const std::string& text) : Error(code, text), who_(who) {}
  Address who() const { return who_; }

 private:
  Address who_;
};

/// Wall time that a node spent blocked in receive(), s.
struct WaitClock {
  double waited_s = 0.0;
};

class Transport {
 public:
  virtual ~Transport() = default;

  virtual Address self() const = 0;
  virtual int tire_count() const = 0;
  virtual int terrain_ranks() const = 0;
  /// The communicator of this rank's role, as MPI_Comm_f2c takes it; the transport owns it. Empty without MPI.
  virtual std::optional<int> role_communicator() const { return std::nullopt; }
  /// The nodes whose processes run on this machine, in rank order, this one included.
  virtual std::vector<HostNode> host_nodes() const { return {{self(), allowed_cores(), true}}; }

  /// Non-blocking; the transport owns the payload until it is delivered. Order is kept per (sender, receiver, kind).
  virtual void send(Address to, MessageKind kind, std::vector<std::byte> payload) = 0;

  /// Waits for the next message of this kind from `from`, and leaves the core to others (test, then sleep with
  /// back-off).
  /// @throws PeerFailure when any node has reported failure;
  ///         Error(rank_lost) "A waited N s for B (kind)" if that peer sends neither message nor heartbeat for
  ///         peer_timeout of this process's own running time
  virtual std::vector<std::byte> receive(Address from, MessageKind kind) = 0;

  /// Waits until everything that was sent has left this process. Call it after all sends and receives of a
  /// synchronization, before long work: a message under way makes no progress while its sender computes. Peers take in
  /// messages during any call that waits, so no order of sends and receives can deadlock.
  virtual void flush() {}

  /// Informs all others that this node is alive while it does something long (settling).
  virtual void heartbeat() = 0;

  /// Informs all others that this node failed. Never throws.
  virtual void announce_failure(ExitCode code, const std::string& text) noexcept = 0;

  /// @throws PeerFailure if another node announced failure; for long work between synchronizations.
  virtual void check_peers() = 0;

  virtual const WaitClock& wait_clock() const = 0;
  virtual void set_peer_timeout(double seconds) = 0;
};

/// Pack/unpack pairs, one per message struct (protocol/pack.cpp).
template <class M>
std::vector<std::byte> pack(const M& message);
/// @throws Error(rank_lost) on a payload that is truncated or has bytes left over.
template <class M>
M unpack(const std::vector<std::byte>& payload);

template <class M>
void send(Transport& transport, Address to, const M& message) {
  transport.send(to, M::kKind, pack(message));
}
template <class M>
M receive(Transport& transport, Address from) {
  return unpack<M>(transport.receive(from, M::kKind));
}
/// Like receive, for messages of the run loop: their step must be `step`.
/// @throws Error(rank_lost) naming sender, kind and both steps.
template <class M>
M receive_step(Transport& transport, Address from, std::int64_t step) {
  M message = receive<M>(transport, from);
  if (message.header.step != step)
    throw Error(ExitCode::rank_lost, to_string(transport.self()) + " expected step " + std::to_string(step) + " from " +
                                         to_string(from) + " but got step " + std::to_string(message.header.step));
  return message;
}

/// Gathers and checks every node's card on every node, so that a mismatch gives the same clear error everywhere.
/// Returned in the order rig, tires, terrain.
/// @throws Error(bad_input) when versions, digests, steps, or tire and wheel counts disagree. On nodes other than the
///         rig it is a PeerFailure of the rig with the same text, so that the user reads it once.
std::vector<NodeCard> handshake(Transport& transport, const NodeCard& own);

/// Transports in one process, one per node, each for a thread of its own (protocol/in_process.cpp).
std::vector<std::unique_ptr<Transport>> make_in_process_transports(int tire_count, int terrain_ranks = 1);

/// World rank 0 is the rig, 1…k the tires, the rest the terrain (protocol/mpi_transport.cpp).
/// MPI is initialised here, and finalised when the process ends.
/// @throws Error(bad_input) when the world has fewer than tire_count + 2 ranks, or more than terrain_ranks allow.
std::unique_ptr<Transport> make_mpi_transport(int* argc, char*** argv, int tire_count, int terrain_ranks);

}  // namespace furrow
