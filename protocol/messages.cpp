#include "protocol/messages.hpp"

#include <iterator>

#include "protocol/core/assert.hpp"

namespace furrow {

std::string to_string(Role role) {
  constexpr const char* kNames[] = {"rig", "tire", "terrain"};
  const auto place = static_cast<std::size_t>(role);
  return place < std::size(kNames) ? kNames[place] : "unknown";
}

Address address_of(int node, int tire_count) {
  FURROW_ASSERT(node >= 0 && tire_count >= 0, node, tire_count);
  if (node == 0) return {Role::rig, 0};
  if (node <= tire_count) return {Role::tire, node - 1};
  return {Role::terrain, node - 1 - tire_count};
}

std::string to_string(const Address& address, int terrain_ranks) {
  const bool one_of_several = address.role == Role::terrain && (terrain_ranks > 1 || address.index > 0);
  if (address.role != Role::tire && !one_of_several) return to_string(address.role);
  return to_string(address.role) + " " + std::to_string(address.index);
}

std::string to_string(MessageKind kind) {
  constexpr const char* kNames[] = {"node card",      "surface setup",  "terrain setup",  "rim motion",
                                    "spindle report", "surface motion", "terrain forces", "terrain report",
                                    "final report",   "control",        "run folder",     "part of a checkpoint",
                                    "its share"};
  const auto place = static_cast<std::size_t>(kind) - 1;
  return place < std::size(kNames) ? kNames[place] : "unknown kind";
}

}  // namespace furrow
