// The ranks of a terrain as a group (protocol/core/rank_group.hpp), by messages between them: they wait as politely as
// nodes do, and a rank that fails or falls silent is named like any other.
#pragma once

#include <memory>

#include "protocol/core/rank_group.hpp"
#include "protocol/transport.hpp"

namespace furrow {

/// The group that this rank belongs to; null for a terrain of one rank, and on ranks that are no terrain's.
/// @param transport outlives the group
std::shared_ptr<RankGroup> make_terrain_group(Transport& transport);

}  // namespace furrow
