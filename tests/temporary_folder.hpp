// A folder that exists during a test.
#pragma once

#include <stdlib.h>

#include "protocol/temporary_folder.hpp"

namespace furrow::testing {

using furrow::TemporaryFolder;

/// A temporary folder that is also the program's cache while it exists.
class OwnCache : public TemporaryFolder {
 public:
  OwnCache() { setenv("XDG_CACHE_HOME", path().c_str(), 1); }
  ~OwnCache() { unsetenv("XDG_CACHE_HOME"); }
};

}  // namespace furrow::testing
