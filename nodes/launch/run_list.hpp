// The list `.furrow-run` of the files that this program wrote into a folder of results. A name is added, and the list
// flushed to the disk, before its file is made. Only listed files are ever removed.
//
//   furrow-run 1              begins a list; lines before the last such line belong to replaced runs
//   summary.json              a file
//   frames/                   a folder
//   frames/tire0_%06d.h5      all files of these names in printf's format: a hundred thousand frames are one line
//   .furrow-begun             not a file: the ranks of the run have taken their first step
//
// Unfinished files (new_file.hpp) belong to their later name. One process writes the list at a time: the process that
// makes or takes the folder, then the rig's rank before any rank writes, then the process that plots.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace furrow::launch {

inline constexpr const char* kRunList = ".furrow-run";
inline constexpr const char* kBegun = ".furrow-begun";

/// Checks whether printf makes `name` from `form` with some number of at least 0 for each "%06d".
/// @param number receives the last of them
bool is_of_form(std::string_view name, std::string_view form, std::int64_t* number = nullptr);

class RunList {
 public:
  explicit RunList(std::vector<std::string> forms = {}) : forms_(std::move(forms)) {}
  /// Reads the folder's list. @throws Error(bad_input) if there is none, or this program cannot read it
  static RunList read(const std::filesystem::path& folder);

  const std::vector<std::string>& forms() const { return forms_; }
  /// Checks whether a file, or a folder whose name ends in '/', is in the list; an unfinished file counts by its later
  /// name.
  bool holds(std::string_view name) const;

  /// Listed files and folders that exist in a folder, by their path in it; a folder comes after all of its content.
  struct Found {
    std::vector<std::string> files, folders;
  };
  /// Links are never followed. @param inside restricts the search: "checkpoints/"
  Found find(const std::filesystem::path& folder, const std::string& inside = "") const;

 private:
  void find(const std::filesystem::path& folder, const std::string& inside, Found& found) const;
  std::vector<std::string> forms_;
};

/// Checks whether anything is at this place, including a link that leads nowhere.
bool stands(const std::filesystem::path& at);
bool has_run_list(const std::filesystem::path& folder);

/// Begins the folder's list again; earlier names no longer count. @throws Error(io)
void begin_run_list(const std::filesystem::path& folder, const std::vector<std::string>& forms);

/// @throws Error(bad_input) if a file of such a name exists that this program did not write
void require_own(const std::filesystem::path& folder, const std::vector<std::string>& forms);

/// Adds names that are not in the list yet; makes a list if the folder has none.
/// @throws Error(bad_input) if a file of such a name exists that this program did not write
/// @throws Error(io)
void add_to_run_list(const std::filesystem::path& folder, const std::vector<std::string>& forms);

/// Removes listed files in the folder below `inside`, and folders that are then empty. Errors are ignored.
void remove_listed(const std::filesystem::path& folder, const RunList& list, const std::string& inside = "");

/// Removes unfinished files that killed runs left. Errors are ignored.
void remove_unfinished(const std::filesystem::path& folder);

}  // namespace furrow::launch
