// What objects save of their state.
#pragma once

#include "protocol/core/archive.hpp"

namespace furrow::testing {

/// What the parts save, in one archive.
template <class... Parts>
Archive saved(const Parts&... parts) {
  Archive archive;
  (parts.save(archive), ...);
  return archive;
}

}  // namespace furrow::testing
