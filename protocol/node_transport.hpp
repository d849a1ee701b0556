// The transport of one node over any wire: addresses, waiting, time-outs, failures.
#pragma once

#include <memory>

#include "protocol/peer_watch.hpp"
#include "protocol/transport.hpp"
#include "protocol/wire.hpp"

namespace furrow {

class NodeTransport final : public Transport {
 public:
  NodeTransport(std::unique_ptr<Wire> wire, int tire_count, std::vector<HostNode> host_nodes);

  Address self() const override { return watch_.address(wire_->self()); }
  int tire_count() const override { return tire_count_; }
  int terrain_ranks() const override { return wire_->node_count() - 1 - tire_count_; }
  std::optional<int> role_communicator() const override { return wire_->role_communicator(); }
  std::vector<HostNode> host_nodes() const override { return host_nodes_; }

  void send(Address to, MessageKind kind, std::vector<std::byte> payload) override;
  std::vector<std::byte> receive(Address from, MessageKind kind) override;
  void flush() override;
  void heartbeat() override;
  void announce_failure(ExitCode code, const std::string& text) noexcept override;
  void check_peers() override;
  const WaitClock& wait_clock() const override { return clock_; }
  void set_peer_timeout(double seconds) override { timeout_ = seconds; }

 private:
  int number(Address node) const;
  template <class Ready, class Peer>
  void wait_until(const Ready& ready, const Peer& peer, const std::string& what);

  std::unique_ptr<Wire> wire_;
  int tire_count_;
  std::vector<HostNode> host_nodes_;
  PeerWatch watch_;
  double timeout_ = 60.0;  // s
  WaitClock clock_;
};

}  // namespace furrow
