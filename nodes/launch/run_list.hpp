// What this program wrote into a folder of results: the list `.furrow-run` in it. A name is added, and the list flushed
// to the disk, before its file is made. Nothing that is not in the list is ever removed.
//
//   furrow-run 1              begins a list; what stands before the last such line is of runs that were replaced
//   summary.json              a file
//   frames/                   a folder
//   frames/tire0_%06d.h5      all files of these names, printed as printf does: a hundred thousand frames are one line
//   .furrow-begun             no file: the ranks of the run have taken their first step
//
// Files in the making (new_file.hpp) belong to the name that they are to get. One process writes the list at a time:
// the process that makes or takes the folder, then the rig's rank before any rank writes, then the one that plots.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace furrow::launch {

inline constexpr const char* kRunList = ".furrow-run";
inline constexpr const char* kBegun = ".furrow-begun";

/// Whether printf with some number of at least 0 in each place of a "%06d" makes `name` of `form`.
/// @param number receives the last of them
bool is_of_form(std::string_view name, std::string_view form, std::int64_t* number = nullptr);

class RunList {
 public:
  explicit RunList(std::vector<std::string> forms = {}) : forms_(std::move(forms)) {}
  /// The folder's. @throws Error(bad_input) when there is none, or none that this program can read
  static RunList read(const std::filesystem::path& folder);

  const std::vector<std::string>& forms() const { return forms_; }
  /// Whether a file, or a folder whose name ends in '/', is in the list; a file in the making counts as what it is to
  /// become.
  bool holds(std::string_view name) const;

  /// What is in a folder of that which is in the list, by its path in there; a folder after all that is in it.
  struct Found {
    std::vector<std::string> files, folders;
  };
  /// Links are never followed. @param inside looks only there: "checkpoints/"
  Found find(const std::filesystem::path& folder, const std::string& inside = "") const;

 private:
  void find(const std::filesystem::path& folder, const std::string& inside, Found& found) const;
  std::vector<std::string> forms_;
};

/// Whether anything is at this place, a link that leads nowhere too.
bool stands(const std::filesystem::path& at);
/// Whether the folder has a list.
bool has_run_list(const std::filesystem::path& folder);

/// Begins the folder's list again; the names before are forgotten. @throws Error(io)
void begin_run_list(const std::filesystem::path& folder, const std::vector<std::string>& forms);

/// @throws Error(bad_input) when a file of such a name stands there that this program did not write
void require_own(const std::filesystem::path& folder, const std::vector<std::string>& forms);

/// Adds those that are not in the list yet, to a list of its own if the folder has none.
/// @throws Error(bad_input) when a file of such a name stands there that this program did not write
/// @throws Error(io)
void add_to_run_list(const std::filesystem::path& folder, const std::vector<std::string>& forms);

/// Removes what is in the list and is in the folder below `inside`, and folders that are empty then. Errors are
/// ignored.
void remove_listed(const std::filesystem::path& folder, const RunList& list, const std::string& inside = "");

/// Removes files in the making that killed runs left. Errors are ignored.
void remove_unfinished(const std::filesystem::path& folder);

}  // namespace furrow::launch
