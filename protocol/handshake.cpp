#include <fmt/format.h>

#include "protocol/core/assert.hpp"
#include "protocol/transport.hpp"

namespace furrow {
namespace {

std::vector<Address> all_nodes(int tire_count, int terrain_ranks) {
  FURROW_ASSERT(tire_count >= 0 && terrain_ranks > 0, tire_count, terrain_ranks);
  std::vector<Address> nodes;
  for (int k = 0; k < 1 + tire_count + terrain_ranks; ++k) nodes.push_back(address_of(k, tire_count));
  return nodes;
}

template <class T>
void require_same(const NodeCard& first, const NodeCard& card, const char* what, const T& a, const T& b) {
  if (a == b) return;
  throw Error(ExitCode::bad_input, fmt::format("handshake: {} of {} is {} but that of {} is {}; expected the same",
                                               what, to_string(first.self), a, to_string(card.self), b));
}

void check(const std::vector<NodeCard>& cards, const std::vector<Address>& nodes, int tires) {
  FURROW_ASSERT(cards.size() == nodes.size() && cards.size() >= 2, cards.size(), nodes.size());
  const NodeCard& rig = cards.front();
  for (std::size_t i = 0; i < cards.size(); ++i) {
    const NodeCard& card = cards[i];
    if (card.self != nodes[i])
      throw Error(ExitCode::bad_input,
                  fmt::format("handshake: {} calls itself {}", to_string(nodes[i]), to_string(card.self)));
    require_same(rig, card, "protocol version", rig.protocol_version, card.protocol_version);
    require_same(rig, card, "scenario digest", rig.scenario_digest, card.scenario_digest);
    require_same(rig, card, "communication step", rig.step, card.step);
    require_same(rig, card, "number of steps", rig.steps, card.steps);
    require_same(rig, card, "first step", rig.from_step, card.from_step);
    if (card.substeps < 1)
      throw Error(ExitCode::bad_input, fmt::format("handshake: {} takes {} substeps; expected 1 or more",
                                                   to_string(card.self), card.substeps));
  }
  if (rig.wheel_count != tires)
    throw Error(
        ExitCode::bad_input,
        fmt::format("handshake: the rig carries {} wheel(s) but the scenario has {} tire(s)", rig.wheel_count, tires));
  for (const NodeCard& card : cards)
    if (card.self.role != Role::tire && card.tire_count != tires)
      throw Error(ExitCode::bad_input, fmt::format("handshake: the {} expects {} tire(s) but there are {}",
                                                   to_string(card.self), card.tire_count, tires));
}

}  // namespace

std::vector<NodeCard> handshake(Transport& transport, const NodeCard& own) {
  const std::vector<Address> nodes = all_nodes(transport.tire_count(), transport.terrain_ranks());
  for (const Address& node : nodes)
    if (node != transport.self()) send(transport, node, own);
  std::vector<NodeCard> cards;
  for (const Address& node : nodes)
    cards.push_back(node == transport.self() ? own : receive<NodeCard>(transport, node));

  try {
    check(cards, nodes, transport.tire_count());
  } catch (const Error& error) {
    // All nodes find the same mistake; the rig reports it.
    if (transport.self() == nodes.front()) throw;
    throw PeerFailure(error.code(), nodes.front(), error.what());
  }
  return cards;
}

}  // namespace furrow
