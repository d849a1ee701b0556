// A folder below the system's folder for temporary files, which ends with this object.
#pragma once

#include <stdlib.h>

#include <filesystem>
#include <string>

#include "protocol/core/error.hpp"

namespace furrow {

class TemporaryFolder {
 public:
  /// @throws Error(io) if it cannot be made
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "furrow-XXXXXX").string();
    if (!mkdtemp(name.data())) throw io_error(name, "cannot be made");
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace furrow
