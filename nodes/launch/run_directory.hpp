// The folder that takes a run's results.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "nodes/launch/folder_lock.hpp"
#include "nodes/launch/run_list.hpp"

namespace furrow::launch {

/// Makes the folder of a run, with the list of what is written into it (run_list.hpp), and takes it away again if the
/// run never started. Results of an earlier run that are to be overwritten are set aside (set_aside.hpp) until it is
/// known that the new one runs. One run at a time has the folder.
class RunDirectory {
 public:
  /// @param out  the user's choice; empty: results/<scenario>-NNN, the first number that is free
  /// @param reads  a file that the run is yet to read: it stays where it is, though a result of the earlier run
  /// @throws Error(bad_input) when `out` exists and may not be overwritten, is another's, or cannot be made
  RunDirectory(const std::string& scenario, const std::filesystem::path& out, bool overwrite,
               const std::filesystem::path& reads = {});
  /// The folder of a run that continues.
  /// @throws Error(bad_input) when it holds none, cannot be written, or others have it
  explicit RunDirectory(const std::filesystem::path& existing);
  /// The folder of a study, which continues where there is one. @throws Error(bad_input)
  static RunDirectory of_study(const std::filesystem::path& folder);
  /// The same of a calibration that writes `files`; `overwrite` sets aside what an earlier one wrote.
  /// @throws Error(bad_input)
  static RunDirectory of_calibration(const std::filesystem::path& folder, bool overwrite,
                                     const std::vector<std::string>& files = {});

  /// Gives the folder free, and removes what was set aside unless the run never began to step: then as `discard`.
  ~RunDirectory();
  RunDirectory(const RunDirectory&) = delete;
  RunDirectory& operator=(const RunDirectory&) = delete;

  const std::filesystem::path& path() const { return path_; }

  /// What is written from now on: files, folders ("frames/") and forms (run_list.hpp).
  /// @throws Error(bad_input) when a file of that name stands there that furrow did not write
  void add(const std::vector<std::string>& names) const { add_to_run_list(path_, names); }

  /// Before the ranks begin: they hold the folder too from then on.
  FolderLock& lock() { return lock_; }

  /// Of a study's folder: sets aside what it holds. @throws Error(bad_input) when it cannot be cleared
  void replace();

  /// Whether results of an earlier run are set aside for one that has not begun to step.
  bool replaces() const;

  /// The run never started: unless it was to continue, removes its results and the folders that the constructor made,
  /// puts back what was set aside.
  void discard();

 private:
  struct Continued;  // kinds of folders that one command makes and continues
  RunDirectory(const Continued& kind, const std::filesystem::path& folder, bool overwrite,
               const std::vector<std::string>& files);

  bool make();
  void begin();
  void take_over(const std::filesystem::path& reads);
  void take_back_of_killed();
  void require_writable(const std::string& key) const;
  void require_no_links(bool continues) const;

  bool existing_ = false;   // not this object's to remove
  bool fresh_ = false;      // the folder had no list before
  bool begun_ = false;      // the list is that of this run
  bool set_aside_ = false;  // results of an earlier run
  FolderLock lock_;
  std::filesystem::path path_;
  std::filesystem::path made_;  // the topmost folder that did not exist before; empty: none
};

/// In a child that will be `furrow run`: it makes no folder but the run's own, whose place stands as long as nobody
/// removes the study's folder.
void make_no_parents();

/// @throws Error(bad_input) unless `folder` holds a run
void require_run_directory(const std::filesystem::path& folder);

/// What waits for a writer, as pipes do, would be read for ever. Looks at every file that the folder's list names, but
/// for parts of checkpoints, which are looked at with their sums. @throws Error(bad_input)
void require_plain_files(const std::filesystem::path& folder);

}  // namespace furrow::launch
