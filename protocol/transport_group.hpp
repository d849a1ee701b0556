// The ranks of a terrain as a group (protocol/core/rank_group.hpp) that exchanges messages. Its ranks wait as nodes do
// and leave their core to others. A rank that fails or falls silent is reported like any other node.
#pragma once

#include <memory>

#include "protocol/core/rank_group.hpp"
#include "protocol/transport.hpp"

namespace furrow {

/// The group of this rank; null for a terrain of one rank, and on ranks that do not compute a terrain.
/// @param transport outlives the group
std::shared_ptr<RankGroup> make_terrain_group(Transport& transport);

}  // namespace furrow
