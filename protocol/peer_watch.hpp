// Whether a node's peers are alive: heartbeats, who waits for whom, and who failed.
//
// Heartbeats pass along chains of waiting. While the terrain settles its bed, the rig waits for the terrain and the
// tire for the rig; the rig is alive, but blocked. So a node that hears a heartbeat from the peer it waits for passes
// it on, once for each heartbeat of each origin. Nodes that wait for one another in a circle get no heartbeats, so such
// a circle times out.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "protocol/core/assert.hpp"
#include "protocol/transport.hpp"
#include "protocol/wire.hpp"

namespace furrow {

class PeerWatch {
 public:
  PeerWatch(Wire& wire, int tire_count);

  /// Reads all control messages that have arrived. @throws PeerFailure, again at every call once a node has failed
  void listen();

  void heartbeat();  // sends at most one a second
  void announce_failure(ExitCode code, const std::string& text);
  bool failed() const { return announced_ || failure_.has_value(); }

  /// Number of signs of life from a node.
  std::int64_t heard(int node) const {
    FURROW_ASSERT(in_range(node, peers_.size()), node, peers_.size());
    return peers_[node].heard;
  }

  /// This node's own wait; the others are informed only of a wait that lasts.
  void begin_wait(int node);
  void tell_wait();
  void end_wait();  // informs nobody after a node has failed

  /// "rig waited 60 s for terrain (terrain report), which waits for tire 0: tire 0 does not answer; …"
  /// The node is then about to fail, so it does not report the end of its wait.
  Error lost(int from, const std::string& what, double timeout);

  Address address(int node) const { return address_of(node, tire_count_); }
  /// Name for messages: "tire 0", "terrain 1".
  std::string name(int node) const;

 private:
  struct Peer {
    std::int64_t heard = 0;
    std::int64_t passed_on = 0;  // newest of its heartbeats that this node has passed on
    int waits_for = -1;
  };
  void tell(int target);
  void to_all_others(const Bytes& payload);

  Wire& wire_;
  int tire_count_;
  std::vector<Peer> peers_;
  std::optional<PeerFailure> failure_;
  std::int64_t heartbeats_ = 0;
  double last_heartbeat_;
  int waits_for_ = -1;
  bool told_ = false;
  bool announced_ = false;
};

}  // namespace furrow
