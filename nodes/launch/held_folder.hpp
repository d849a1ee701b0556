// A rank's hold on its run's folder. No other run can take the folder while the rank lives, and the rank notices if the
// folder was moved or removed.
#pragma once

#include <filesystem>
#include <vector>

#include "nodes/launch/folder_lock.hpp"

namespace furrow::launch {

class HeldFolder {
 public:
  /// @throws Error(bad_input) if another run has it alone
  /// @throws Error(io) if it does not have a list
  explicit HeldFolder(const std::filesystem::path& folder);

  /// Call it before anything is written to a path: a moved or removed folder must not be made again.
  /// @throws Error(io) if the folder, or an earlier folder in it, was moved, removed or emptied
  void check();

 private:
  struct Part {
    std::filesystem::path folder;
    std::uintmax_t device = 0, number = 0;  // 0: not there yet
  };
  std::filesystem::path folder_;
  FolderLock lock_;
  std::vector<Part> parts_;
};

}  // namespace furrow::launch
