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

/// Thrown out of any transport call when another node failed or was lost. The failing node has already informed the
/// user, so the code that catches this ends quietly with `code`.
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
  /// The communicator of this rank's role, as MPI_Comm_f2c takes it; it belongs to the transport. None without MPI.
  virtual std::optional<int> role_communicator() const { return std::nullopt; }
  /// The nodes whose processes run on this machine, in rank order, this one included.
  virtual std::vector<HostNode> host_nodes() const { return {{self(), allowed_cores(), true}}; }

  /// Non-blocking; the transport owns the payload until it is delivered. Order is kept per (sender, receiver, kind).
  virtual void send(Address to, MessageKind kind, std::vector<std::byte> payload) = 0;

  /// Waits politely (test, yield, then sleep with back-off) for the next message of this kind from `from`.
  /// @throws PeerFailure when any node has reported failure;
  ///         Error(rank_lost) "A waited N s for B (kind)" after peer_timeout of this process's own running time
  ///         without message or heartbeat from that peer.
  virtual std::vector<std::byte> receive(Address from, MessageKind kind) = 0;

  /// Waits until everything sent has left this process. To be called when all sends and receives of a synchronization
  /// are done and before long work: a message under way makes no progress while its sender computes.
  /// Peers take what is sent to them in any call that waits, so no order of sends and receives can deadlock.
  virtual void flush() {}

  /// Tells all others that this node is alive while it does something long (settling).
  virtual void heartbeat() = 0;

  /// Tells all others that this node failed. Never throws.
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
/// As receive, for messages of the run loop: the step must be `step`.
/// @throws Error(rank_lost) naming sender, kind and both steps.
template <class M>
M receive_step(Transport& transport, Address from, std::int64_t step) {
  M message = receive<M>(transport, from);
  if (message.header.step != step)
    throw Error(ExitCode::rank_lost, to_string(transport.self()) + " expected step " + std::to_string(step) + " from " +
                                         to_string(from) + " but got step " + std::to_string(message.header.step));
  return message;
}

/// Every node's card, gathered by all and checked by all, so that a mismatch is the same clear error everywhere.
/// Returned in the order rig, tires, terrain.
/// @throws Error(bad_input) when versions, digests, steps, or tire and wheel counts disagree; on nodes other than the
///         rig as a PeerFailure of the rig with the same text, so that the user reads it once.
std::vector<NodeCard> handshake(Transport& transport, const NodeCard& own);

/// In one process: one transport per node, each to be used by a thread of its own (protocol/in_process.cpp).
std::vector<std::unique_ptr<Transport>> make_in_process_transports(int tire_count, int terrain_ranks = 1);

/// World rank 0 is the rig, 1…k the tires, the rest the terrain (protocol/mpi_transport.cpp).
/// MPI is initialised here, and finalised when the process ends.
/// @throws Error(bad_input) when the world has fewer than tire_count + 2 ranks, or more than terrain_ranks allow.
std::unique_ptr<Transport> make_mpi_transport(int* argc, char*** argv, int tire_count, int terrain_ranks);

}  // namespace furrow
