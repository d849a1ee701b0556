// The folder that takes a run's results.
#pragma once

#include <filesystem>
#include <string>

namespace furrow::launch {

/// Makes the folder of a run and takes it away again if the run never came to be. Results of an earlier run that
/// are to be overwritten are set aside until it is known that the new one runs. One process at a time has the folder.
class RunDirectory {
 public:
  /// @param out  the user's choice; empty: results/<scenario>-NNN, the first number that is free
  /// @throws Error(bad_input) when `out` exists and may not be overwritten, or cannot be made
  RunDirectory(const std::string& scenario, const std::filesystem::path& out, bool overwrite);
  /// The folder of a run that goes on.
  /// @throws Error(bad_input) when it holds none, cannot be written, or another process has it
  explicit RunDirectory(const std::filesystem::path& existing);

  /// Gives the folder free and removes what was set aside.
  ~RunDirectory();
  RunDirectory(const RunDirectory&) = delete;
  RunDirectory& operator=(const RunDirectory&) = delete;

  const std::filesystem::path& path() const { return path_; }

  /// The run never came to be: unless it was to go on, removes its results and the folders that the constructor made,
  /// puts back what was set aside.
  void discard();

 private:
  /// @returns false when it exists by now
  bool make(const std::filesystem::path& folder);
  void take_over();
  void require_writable(const std::string& key) const;
  void lock(const std::string& key = "--out");
  std::filesystem::path aside() const { return path_ / ".before"; }

  int folder_ = -1;  // open and locked as long as this lives
  bool set_aside_ = false;
  bool existing_ = false;
  std::filesystem::path path_;
  std::filesystem::path made_;  // the topmost folder that did not exist before; empty: none
};

/// Takes a folder for this process. @returns a descriptor to close; the lock ends with it, or with the process
/// @param key for the message
/// @throws Error(bad_input) when another process has it
int lock_folder(const std::filesystem::path& folder, const std::string& key);

/// @throws Error(bad_input) unless `folder` holds a run
void require_run_directory(const std::filesystem::path& folder);

}  // namespace furrow::launch
