// Lock on a results folder: a lock on its list of files (run_list.hpp). The system releases it when the last process
// that holds it ends for any reason.
//
// A run takes its folder alone, prepares it, and shares it before its ranks begin. From then on the supervisor, mpirun
// (which inherits the supervisor's descriptor) and every rank hold it together. A process that wants the folder alone
// therefore waits for the last of them, even if the supervisor was killed.
#pragma once

#include <filesystem>
#include <string>

namespace furrow::launch {

class FolderLock {
 public:
  enum class Mode { alone, together };
  static constexpr double kPatience = 10.0;  // s

  FolderLock() = default;  // locks nothing
  /// Makes the list if the folder has none. In mode `alone`, it waits up to `patience` seconds for the holders and
  /// prints that it waits; then it ends left launchers (left_launcher.hpp).
  /// @param key for messages
  /// @throws Error(bad_input) if other processes keep the folder; the message names them
  /// @throws Error(io) if the list cannot be opened
  FolderLock(const std::filesystem::path& folder, const std::string& key, Mode mode, double patience = kPatience);
  FolderLock(FolderLock&& other) noexcept;
  FolderLock& operator=(FolderLock&& other) noexcept;
  ~FolderLock();

  /// Shares the folder with the ranks from now on. @throws Error(bad_input) if another run took it in between
  void share();

  /// Checks whether the path still leads to the locked list: the folder was not moved, removed or emptied.
  bool stands() const;

  /// For a child that also holds the lock; −1: no lock.
  int descriptor() const { return handle_; }

 private:
  bool try_to_take(int operation) const;
  std::filesystem::path folder_;
  std::string key_;
  int handle_ = -1;
};

/// Waits until nobody holds the folder, for at most FolderLock::kPatience. A folder without a list is free.
void wait_until_free(const std::filesystem::path& folder);

}  // namespace furrow::launch
