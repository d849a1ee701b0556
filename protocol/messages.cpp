#include "protocol/messages.hpp"

namespace furrow {

std::string to_string(Role role) {
  switch (role) {
    case Role::rig:
      return "rig";
    case Role::tire:
      return "tire";
    case Role::terrain:
      return "terrain";
  }
  return "unknown";
}

std::string to_string(const Address& address, int terrain_ranks) {
  const bool one_of_several = address.role == Role::terrain && (terrain_ranks > 1 || address.index > 0);
  if (address.role != Role::tire && !one_of_several) return to_string(address.role);
  return to_string(address.role) + " " + std::to_string(address.index);
}

std::string to_string(MessageKind kind) {
  switch (kind) {
    case MessageKind::node_card:
      return "node card";
    case MessageKind::surface_setup:
      return "surface setup";
    case MessageKind::terrain_setup:
      return "terrain setup";
    case MessageKind::rim_motion:
      return "rim motion";
    case MessageKind::spindle_report:
      return "spindle report";
    case MessageKind::surface_motion:
      return "surface motion";
    case MessageKind::terrain_forces:
      return "terrain forces";
    case MessageKind::terrain_report:
      return "terrain report";
    case MessageKind::final_report:
      return "final report";
    case MessageKind::control:
      return "control";
    case MessageKind::run_folder:
      return "run folder";
    case MessageKind::checkpoint_part:
      return "part of a checkpoint";
    case MessageKind::group:
      return "its share";
  }
  return "unknown kind";
}

}  // namespace furrow
