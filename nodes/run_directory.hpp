// The folder that takes a run's results.
#pragma once

#include <filesystem>
#include <string>

namespace furrow {

/// Makes the folder of a run and takes it away again if the run never came to be.
class RunDirectory {
 public:
  /// @param out  the user's choice; empty: results/<scenario>-NNN, the first number that is free
  /// @throws Error(bad_input) when `out` exists and may not be overwritten, or cannot be made
  RunDirectory(const std::string& scenario, const std::filesystem::path& out, bool overwrite);

  const std::filesystem::path& path() const { return path_; }

  /// Removes what the constructor made, as long as no results stand in it.
  void discard();

 private:
  /// @returns false when it exists by now
  bool make(const std::filesystem::path& folder);
  void take_over();

  std::filesystem::path path_;
  std::filesystem::path made_;  // the topmost folder that did not exist before; empty: none
};

/// @throws Error(bad_input) unless `folder` holds a run
void require_run_directory(const std::filesystem::path& folder);

}  // namespace furrow
