// Decides which steps get a frame, and its number. Numbers of a continued run follow the earlier ones, even if the
// interval changes.
#pragma once

#include <cstdint>

#include "protocol/core/assert.hpp"
#include "protocol/core/fields.hpp"

namespace furrow::checkpoint {

struct FrameClock {
  std::int64_t every = 0;        // steps; 0: no frames
  std::int64_t first_step = 0;   // of this segment of the run
  std::int64_t first_index = 0;  // of its first frame

  bool due(std::int64_t step) const {
    FURROW_ASSERT(step >= 0, step);
    return every > 0 && step % every == 0;
  }
  /// Number of the first frame at `step` or later.
  std::int64_t index(std::int64_t step) const {
    return every > 0 ? first_index + before(step) - before(first_step) : first_index;
  }
  /// Returns the clock of the segment that begins at `step`. @param written  whether a frame of that step exists: it
  /// stays if the segment will not make it again
  FrameClock continued(std::int64_t step, std::int64_t new_every, bool written = false) const {
    FURROW_ASSERT(new_every >= 0, step, new_every);
    const bool stays = written && due(step) && !(new_every > 0 && step % new_every == 0);
    return {new_every, step, index(step) + (stays ? 1 : 0)};
  }

 private:
  /// Multiples of `every` in [0, step).
  std::int64_t before(std::int64_t step) const {
    FURROW_ASSERT(every > 0 && step >= 0, every, step);
    return (step + every - 1) / every;
  }
};
void visit_fields(FieldsOf<FrameClock> auto& s, auto&& visit) {
  visit(s.every, Field{"every"});
  visit(s.first_step, Field{"first_step"});
  visit(s.first_index, Field{"first_index"});
}

}  // namespace furrow::checkpoint
