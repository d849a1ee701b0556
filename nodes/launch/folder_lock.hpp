// Who has a folder of results: a lock on its list of files (run_list.hpp), which the system gives free when the last
// process that holds it ends, however it ends.
//
// A run takes its folder alone, prepares it, and shares it before its ranks begin: the supervisor, mpirun (which
// inherits the supervisor's descriptor) and every rank hold it together from then on. Whoever wants the folder alone
// therefore waits for the last of them, also when the supervisor was killed.
#pragma once

#include <filesystem>
#include <string>

namespace furrow::launch {

class FolderLock {
 public:
  enum class Mode { alone, together };
  static constexpr double kPatience = 10.0;  // s

  FolderLock() = default;  // of nothing
  /// The list is made where the folder has none. Alone: waits up to `patience` seconds for
  /// those that have it, and says so; then ends what has it for nothing (left_launcher.hpp).
  /// @param key for messages
  /// @throws Error(bad_input) when others keep it; they are named
  /// @throws Error(io) when the list cannot be opened
  FolderLock(const std::filesystem::path& folder, const std::string& key, Mode mode, double patience = kPatience);
  FolderLock(FolderLock&& other) noexcept;
  FolderLock& operator=(FolderLock&& other) noexcept;
  ~FolderLock();

  /// From now on with the ranks. @throws Error(bad_input) when another run took it in between
  void share();

  /// Whether the path still leads to the list that is locked: the folder was neither moved, removed nor emptied.
  bool stands() const;

  /// For a child that is to hold it as well; −1: of nothing.
  int descriptor() const { return handle_; }

 private:
  bool try_to_take(int operation) const;
  std::filesystem::path folder_;
  std::string key_;
  int handle_ = -1;
};

/// Waits until nobody has the folder, FolderLock::kPatience at most. A folder without a list is free.
void wait_until_free(const std::filesystem::path& folder);

}  // namespace furrow::launch
