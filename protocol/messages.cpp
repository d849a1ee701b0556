#include "protocol/messages.hpp"

namespace furrow {

std::string to_string(Role role) {
  switch (role) {
    case Role::rig: return "rig";
    case Role::tire: return "tire";
    case Role::terrain: return "terrain";
  }
  return "unknown";
}

std::string to_string(const Address& address) {
  return address.role == Role::tire ? "tire " + std::to_string(address.index) : to_string(address.role);
}

}  // namespace furrow
