#include "protocol/peer_watch.hpp"

#include <limits>

#include <fmt/format.h>

#include "protocol/core/assert.hpp"
#include "protocol/core/byte_stream.hpp"
#include "protocol/peer_clock.hpp"

namespace furrow {
namespace {

constexpr double kHeartbeatInterval = 1.0;  // s

/// First field of a control message.
enum class Control : std::int32_t { heartbeat = 0, failure = 1, waiting = 2 };

}  // namespace

PeerWatch::PeerWatch(Wire& wire, int tire_count)
    : wire_(wire),
      tire_count_(tire_count),
      peers_(wire.node_count()),
      last_heartbeat_(-std::numeric_limits<double>::infinity()) {}

std::string PeerWatch::name(int node) const {
  return to_string(address(node), static_cast<int>(peers_.size()) - 1 - tire_count_);
}

void PeerWatch::listen() {
  while (const auto message = wire_.take_control()) {
    Peer& peer = peers_[message->from];
    ByteReader reader(message->payload);
    Control what{};
    reader(what);
    if (what == Control::heartbeat) {
      std::int32_t origin = 0;
      std::int64_t count = 0;
      reader(origin);
      reader(count);
      if (origin == wire_.self() || origin < 0 || origin >= wire_.node_count()) continue;
      ++peer.heard;
      if (waits_for_ == message->from && peers_[origin].passed_on < count) {
        peers_[origin].passed_on = count;
        to_all_others(message->payload);
      }
    } else if (what == Control::waiting) {
      std::int32_t target = -1;
      reader(target);
      peer.waits_for = target;
    } else if (what == Control::failure) {
      ExitCode code{};
      std::string text;
      reader(code);
      reader(text);
      if (!failure_) failure_.emplace(code, address(message->from), text);
    }
  }
  if (failure_) throw *failure_;
}

void PeerWatch::heartbeat() {
  const double at = wall_clock();
  if (at - last_heartbeat_ < kHeartbeatInterval) return;
  last_heartbeat_ = at;
  ByteWriter writer;
  writer(Control::heartbeat);
  writer(static_cast<std::int32_t>(wire_.self()));
  writer(++heartbeats_);
  to_all_others(writer.take());
}

void PeerWatch::announce_failure(ExitCode code, const std::string& text) {
  FURROW_ASSERT(code != ExitCode::done, static_cast<int>(code), text);
  if (failed()) return;  // only the node that failed reports a failure
  announced_ = true;
  ByteWriter writer;
  writer(Control::failure);
  writer(code);
  writer(text);
  to_all_others(writer.take());
}

void PeerWatch::begin_wait(int node) {
  FURROW_ASSERT(in_range(node, peers_.size()) && node != wire_.self(), node, wire_.self());
  waits_for_ = node;
}

void PeerWatch::tell_wait() {
  if (told_) return;
  told_ = true;
  tell(waits_for_);
}

void PeerWatch::end_wait() {
  waits_for_ = -1;
  if (told_ && !failed()) tell(-1);  // after a failure the others still need the node that this one waited for
  told_ = false;
}

void PeerWatch::tell(int target) {
  FURROW_ASSERT(target >= -1 && target < wire_.node_count(), target, wire_.node_count());
  ByteWriter writer;
  writer(Control::waiting);
  writer(static_cast<std::int32_t>(target));
  to_all_others(writer.take());
}

Error PeerWatch::lost(int from, const std::string& what, double timeout) {
  FURROW_ASSERT(in_range(from, peers_.size()), from, peers_.size());
  told_ = false;  // a node whose wait times out now still needs the node that this one waited for
  std::string text = fmt::format("{} waited {:g} s for {} ({})", name(wire_.self()), timeout, name(from), what);
  std::vector<bool> met(peers_.size(), false);
  met[wire_.self()] = true;
  int silent = from;
  while (!met[silent] && peers_[silent].waits_for >= 0) {
    met[silent] = true;
    silent = peers_[silent].waits_for;
    text += fmt::format(", which waits for {}", name(silent));
  }
  if (met[silent]) return Error(ExitCode::rank_lost, text + ": the nodes wait for one another");
  text += fmt::format(": {} does not answer; raise run.peer_timeout if it is only slow", name(silent));
  int terrains = 0;
  for (int node = 0; node < wire_.node_count(); ++node) terrains += address(node).role == Role::terrain ? 1 : 0;
  if (terrains > 1 && address(silent) == Address{Role::terrain, 0})
    text += fmt::format("; it may wait inside its engine for one of terrain 1 to {}", terrains - 1);
  return Error(ExitCode::rank_lost, text);
}

void PeerWatch::to_all_others(const Bytes& payload) {
  FURROW_ASSERT(!payload.empty(), payload.size());
  for (int node = 0; node < wire_.node_count(); ++node)
    if (node != wire_.self()) wire_.send_control(node, payload);
}

}  // namespace furrow
