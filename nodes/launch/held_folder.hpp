// A rank's hold on the folder of its run: no other run can have it as long as the rank lives, and the rank notices when
// the folder is no longer where it was.
#pragma once

#include <filesystem>
#include <vector>

#include "nodes/launch/folder_lock.hpp"

namespace furrow::launch {

class HeldFolder {
 public:
  /// @throws Error(bad_input) when another run has it alone
  /// @throws Error(io) when it has no list
  explicit HeldFolder(const std::filesystem::path& folder);

  /// To be called before anything is written by name: what was moved or removed must not be made again.
  /// @throws Error(io) when the folder was moved, removed or emptied, or one in it that was there before
  void check();

 private:
  struct Part {
    std::filesystem::path folder;
    std::uintmax_t device = 0, number = 0;  // 0: not there so far
  };
  std::filesystem::path folder_;
  FolderLock lock_;
  std::vector<Part> parts_;
};

}  // namespace furrow::launch
