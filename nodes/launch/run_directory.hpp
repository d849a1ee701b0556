// The folder for a run's results.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "nodes/launch/folder_lock.hpp"
#include "nodes/launch/run_list.hpp"

namespace furrow::launch {

/// Makes a run's folder with the list of written files (run_list.hpp), and removes it if the run never started. Results
/// of an earlier run that will be overwritten are set aside (set_aside.hpp) until the new run is under way. Only one
/// run at a time has the folder.
class RunDirectory {
 public:
  /// @param out  the user's choice; empty: results/<scenario>-NNN, with the first free number
  /// @param reads  a file that the run will read: it stays in place, although it is a result of the earlier run
  /// @throws Error(bad_input) if `out` exists and may not be overwritten, is not furrow's, or cannot be made
  RunDirectory(const std::string& scenario, const std::filesystem::path& out, bool overwrite,
               const std::filesystem::path& reads = {});
  /// The folder of a run that continues.
  /// @throws Error(bad_input) if it does not hold a run, cannot be written, or another process has it
  explicit RunDirectory(const std::filesystem::path& existing);
  /// Returns the folder of a study, which continues if it exists. @throws Error(bad_input)
  static RunDirectory of_study(const std::filesystem::path& folder);
  /// Returns the folder of a calibration that writes `files`; `overwrite` sets aside the files of an earlier one.
  /// @throws Error(bad_input)
  static RunDirectory of_calibration(const std::filesystem::path& folder, bool overwrite,
                                     const std::vector<std::string>& files = {});

  /// Releases the folder and removes what was set aside. If the run never began to step, it acts as `discard`.
  ~RunDirectory();
  RunDirectory(const RunDirectory&) = delete;
  RunDirectory& operator=(const RunDirectory&) = delete;

  const std::filesystem::path& path() const { return path_; }

  /// Lists names that will be written from now on: files, folders ("frames/") and forms (run_list.hpp).
  /// @throws Error(bad_input) if a file of such a name exists that furrow did not write
  void add(const std::vector<std::string>& names) const { add_to_run_list(path_, names); }

  /// The lock; share it before the ranks begin, which hold the folder too from then on.
  FolderLock& lock() { return lock_; }

  /// Sets aside the content of a study's folder. @throws Error(bad_input) if it cannot be cleared
  void replace();

  /// Checks whether results of an earlier run are set aside for a run that has not begun to step.
  bool replaces() const;

  /// For a run that never started: removes its results and the folders that the constructor made, and puts back what
  /// was set aside. Does nothing to a run that was to continue.
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

  bool existing_ = false;   // this object must not remove it
  bool fresh_ = false;      // the folder had no list before
  bool begun_ = false;      // the list is this run's
  bool set_aside_ = false;  // results of an earlier run
  FolderLock lock_;
  std::filesystem::path path_;
  std::filesystem::path made_;  // the topmost folder that did not exist before; empty: none
};

/// Lets a child, which becomes `furrow run`, make only the run's own folder. The parent exists unless somebody removes
/// the study's folder.
void make_no_parents();

/// @throws Error(bad_input) unless `folder` contains a run
void require_run_directory(const std::filesystem::path& folder);

/// Refuses files such as pipes, which would be read forever. Checks every file in the folder's list except parts of
/// checkpoints, which are checked with their sums. @throws Error(bad_input)
void require_plain_files(const std::filesystem::path& folder);

}  // namespace furrow::launch
