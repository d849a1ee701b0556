// Saved states of objects.
#pragma once

#include "protocol/core/archive.hpp"

namespace furrow::testing {

/// The states of the parts in one archive.
template <class... Parts>
Archive saved(const Parts&... parts) {
  Archive archive;
  (parts.save(archive), ...);
  return archive;
}

}  // namespace furrow::testing
