// The step at which a run is complete before its planned end. Nodes save it in checkpoints, because these may be
// written while some nodes have not received it yet.
#pragma once

#include <cstdint>

#include "protocol/core/archive.hpp"
#include "protocol/messages.hpp"

namespace furrow::ranks {

inline constexpr char kEndsAt[] = "run/ends_at";

inline void save_end(Archive& archive, std::int64_t ends_at) {
  if (ends_at != kNotYet) archive.put(kEndsAt, ends_at);
}
inline std::int64_t saved_end(const Archive& archive) {
  return archive.has(kEndsAt) ? archive.get_int(kEndsAt) : kNotYet;
}

}  // namespace furrow::ranks
