// What carries bytes between nodes, which are numbered rig, tires, terrain (its leader first). Two implementations:
// queues between threads, and MPI. All that the two have in common is in node_transport.hpp.
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

/// The first of a queue, which loses it.
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
  /// As Transport::role_communicator.
  virtual std::optional<int> role_communicator() const { return std::nullopt; }

  /// Non-blocking; order is kept per (sender, receiver, kind), and among the control messages of one sender.
  virtual void send(int to, MessageKind kind, Bytes payload) = 0;
  virtual void send_control(int to, Bytes payload) = 0;

  /// Takes everything that has arrived, from anyone, out of the sender's way; never waits.
  virtual void progress() = 0;
  /// What progress() has taken, in order.
  virtual std::optional<Bytes> take(int from, MessageKind kind) = 0;
  virtual std::optional<ControlBytes> take_control() = 0;

  /// A node to which something is still under way that needs this process to get there, or −1.
  virtual int unsent_to() const = 0;

  /// Passes the time politely until something may have arrived.
  /// @param polls  how often in a row nothing was there, from 0
  /// @param waited s, since then
  virtual void idle(int polls, double waited) = 0;

  /// Called once when a node has failed: the wire's end must not wait for ever for nodes that may be gone.
  virtual void expect_losses(double patience, int exit_code) noexcept = 0;
};

}  // namespace furrow
