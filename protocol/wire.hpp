// Carries bytes between nodes, which are numbered rig, tires, terrain (its leader first). There are two
// implementations: queues between threads, and MPI. node_transport.hpp contains all that they have in common.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "protocol/messages.hpp"

namespace furrow {

using Bytes = std::vector<std::byte>;

struct ControlBytes {
  int from = 0;
  Bytes payload;
};

/// Takes the first entry out of a queue.
template <class T>
std::optional<T> pop(std::deque<T>& queue) {
  if (queue.empty()) return std::nullopt;
  std::optional<T> first(std::move(queue.front()));
  queue.pop_front();
  return first;
}

class Wire {
 public:
  virtual ~Wire() = default;

  virtual int self() const = 0;
  virtual int node_count() const = 0;
  /// See Transport::role_communicator.
  virtual std::optional<int> role_communicator() const { return std::nullopt; }

  /// Non-blocking; order is kept per (sender, receiver, kind), and among the control messages of one sender.
  virtual void send(int to, MessageKind kind, Bytes payload) = 0;
  virtual void send_control(int to, Bytes payload) = 0;

  /// Takes in everything that has arrived, from any node, so that no sender has to wait; never waits itself.
  virtual void progress() = 0;
  /// The next message that progress() has taken in, in order.
  virtual std::optional<Bytes> take(int from, MessageKind kind) = 0;
  virtual std::optional<ControlBytes> take_control() = 0;

  /// A node to which a message is still under way that needs this process to get there, or −1.
  virtual int unsent_to() const = 0;

  /// Waits until a message may have arrived, and leaves the core to others.
  /// @param polls  empty polls in a row, from 0
  /// @param waited time since the first of them, s
  virtual void idle(int polls, double waited) = 0;

  /// Called once after a node has failed: the wire must then not wait for ever, as it ends, for nodes that may be gone.
  virtual void expect_losses(double patience, int exit_code) noexcept = 0;
};

}  // namespace furrow
