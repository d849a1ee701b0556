#include "nodes/launch/run_directory.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "nodes/launch/set_aside.hpp"
#include "protocol/core/error.hpp"

namespace furrow::launch {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxNumbers = 100000;
constexpr const char* kNoParents = "FURROW_MAKES_NO_PARENTS";
constexpr const char* kKinematics = "kinematics.csv";  // of `furrow kc`
constexpr const char* kModes = "modes.csv";            // of `furrow modes`

Error no_list(const fs::path& folder, const std::string& key, const std::string& why) {
  return input_error(folder.string(), key, "holds no run's list of its files ({}): {}", kRunList, why);
}

/// Results of one command, by a file in the list of its folder.
struct Kind {
  const char* mark;
  const char* holds;
  const char* continued;  // how they are continued
};
constexpr Kind kOthers[] = {
    {kCalibration, "a calibration", "the command that began it, 'furrow calibrate' with the same study, continues it"},
    {kKinematics, "the results of 'furrow kc'", "the same command makes them again and cannot continue them"},
    {kModes, "the results of 'furrow modes'", "the same command makes them again and cannot continue them"},
    {"soil.json", "the results of 'furrow soil'", "the same command makes them again and cannot continue them"},
    {"press.csv", "the results of 'furrow press'", "the same command makes them again and cannot continue them"}};

bool is_run(const fs::path& folder) {
  std::error_code error;
  return fs::exists(folder / "run.log", error) || fs::exists(folder / "scenario.json", error) ||
         fs::exists(folder / kStudy, error) || fs::exists(folder / kKinematics, error) ||
         fs::exists(folder / kModes, error) || fs::exists(folder / kCalibration, error);
}

/// Removes separators at the end. @throws Error(bad_input) for a path through a folder that does not exist
fs::path way_to(const fs::path& out) {
  fs::path way;
  bool missing = false;
  for (const fs::path& part : out) {
    if (part.empty()) continue;
    if (missing && part == "..")
      throw input_error(out.string(), "--out",
                        "leads through '" + way.string() + "', which does not exist, expected a way without it");
    way /= part;
    std::error_code error;
    missing = missing || !fs::exists(way, error);
  }
  return way;
}

/// Checks whether the folder has a list or is empty: another process may be about to begin the list.
bool may_be_own(const fs::path& folder) {
  std::error_code error;
  const bool bare = std::all_of(fs::directory_iterator(folder, error), fs::directory_iterator(),
                                [](const fs::directory_entry& entry) { return entry.path().filename() == kRunList; });
  return bare || has_run_list(folder);
}

}  // namespace

RunDirectory::RunDirectory(const std::string& scenario, const fs::path& out, bool overwrite, const fs::path& reads) {
  try {
    bool made = false;
    for (int number = 1; out.empty() && !made && number < kMaxNumbers; ++number) {
      path_ = fs::path("results") / fmt::format("{}-{:03}", scenario, number);
      made = !stands(path_) && make();
    }
    if (out.empty() && !made)
      throw input_error("results", "", "holds too many runs of " + scenario + ", expected --out");
    if (!out.empty()) {
      path_ = way_to(out);
      made = !stands(path_) && make();
    }
    std::error_code error;
    if (!made && !fs::is_directory(path_, error))
      throw input_error(out.string(), "--out", "exists and is not a folder, expected a new folder");
    if (!made && !overwrite && !fs::is_empty(path_, error))
      throw input_error(out.string(), "--out", "exists already, expected a new folder or --overwrite");
    if (made)
      begin();
    else
      take_over(reads);
  } catch (const Error&) {
    discard();
    throw;
  }
}

RunDirectory::RunDirectory(const fs::path& existing) : existing_(true), path_(existing) {
  take_back_of_killed();
  require_run_directory(existing);
  require_plain_files(existing);
  if (!has_run_list(path_))
    throw no_list(path_, "",
                  "an earlier version of furrow made it; continue it with that version, or start again with furrow run "
                  "in a new folder");
  require_writable("");
  const RunList list = RunList::read(path_);
  for (const Kind& kind : kOthers)
    if (list.holds(kind.mark))
      throw input_error(path_.string(), "", "holds {}, expected a run; {}", kind.holds, kind.continued);
  if (!lock_.stands()) lock_ = FolderLock(path_, "", FolderLock::Mode::alone);
  require_no_links(true);
  take_back(path_);  // from an earlier holder of the folder
}

struct RunDirectory::Continued {
  const char* mark;  // a file in its list
  const char* name;
};

RunDirectory::RunDirectory(const Continued& kind, const fs::path& folder, bool overwrite,
                           const std::vector<std::string>& files)
    : path_(way_to(folder)) {
  try {
    if (!stands(path_) && make()) {
      begin();
    } else {
      std::error_code error;
      if (!fs::is_directory(path_, error))
        throw input_error(folder.string(), "--out", "exists and is not a folder, expected a new one or that of a {}",
                          kind.name);
      if (!may_be_own(path_))
        throw no_list(folder, "--out",
                      fmt::format("no {} made it, or an earlier version of furrow did; expected a new or empty folder",
                                  kind.name));
      require_writable("--out");
      lock_ = FolderLock(path_, "--out", FolderLock::Mode::alone);
      take_back(path_);
      const RunList list = RunList::read(path_);
      if (!list.forms().empty() && !list.holds(kind.mark))
        throw input_error(folder.string(), "--out", "holds a run, expected a new folder or that of a {}", kind.name);
      require_own(path_, files);
      if (overwrite) replace();
    }
  } catch (const Error&) {
    discard();
    throw;
  }
  existing_ = !set_aside_;
}

RunDirectory RunDirectory::of_study(const fs::path& folder) { return {Continued{kStudy, "study"}, folder, false, {}}; }

RunDirectory RunDirectory::of_calibration(const fs::path& folder, bool overwrite,
                                          const std::vector<std::string>& files) {
  return {Continued{kCalibration, "calibration"}, folder, overwrite, files};
}

void RunDirectory::require_writable(const std::string& key) const {
  if (access(path_.c_str(), W_OK | X_OK) != 0)
    throw input_error(path_.string(), key, "cannot be written, expected a place that can be written");
}

/// Files behind a link would be neither listed nor locked.
void RunDirectory::require_no_links(bool continues) const {
  std::error_code error;
  const RunList list = RunList::read(path_);
  for (const auto& entry : fs::directory_iterator(path_, error)) {
    const std::string name = entry.path().filename().string();
    const bool written_on = continues && (name == "run.log" || name.starts_with("timeseries")) && list.holds(name);
    if (written_on && !fs::is_regular_file(entry.status(error)))
      throw input_error(entry.path().string(), "", "is not a file, expected one, or none at this place");
    if (!fs::is_symlink(entry.symlink_status(error)) || !(written_on || list.holds(name + "/"))) continue;
    throw input_error(entry.path().string(), "",
                      "is a link, expected what it leads to: results are not written through links; move the whole "
                      "folder of the run instead");
  }
}

void make_no_parents() { setenv(kNoParents, "1", 1); }

/// @returns false if it exists by now
bool RunDirectory::make() {
  std::vector<fs::path> missing;
  fs::path at;
  for (const fs::path& part : path_) {
    at /= part;
    std::error_code error;
    if (!fs::exists(at, error)) missing.push_back(at);
  }
  if (missing.size() > 1 && std::getenv(kNoParents))
    throw io_error(missing.front().string(), "was moved or removed while its study was under way");
  for (const fs::path& folder : missing) {
    if (mkdir(folder.c_str(), 0777) == 0) {
      if (made_.empty()) made_ = folder;
      continue;
    }
    const int reason = errno;
    if (reason == EEXIST && folder != missing.back()) continue;  // another run made it at the same time
    discard();
    if (reason == EEXIST) return false;
    throw input_error(path_.string(), "--out", "cannot be made ({}), expected a place that can be written",
                      std::strerror(reason));
  }
  return true;
}

void RunDirectory::begin() {
  if (!lock_.stands()) lock_ = FolderLock(path_, "--out", FolderLock::Mode::alone);
  if (has_run_list(path_) && !RunList::read(path_).forms().empty())
    throw input_error(path_.string(), "--out", "was taken by another run as this one began, expected a new folder");
  fresh_ = true;
  begin_run_list(path_, {});
  begun_ = true;
}

void RunDirectory::take_over(const fs::path& reads) {
  if (!may_be_own(path_))
    throw no_list(
        path_, "--out",
        "no run made it, or an earlier version of furrow did; expected a new or empty folder (move this one away)");
  require_writable("--out");
  lock_ = FolderLock(path_, "--out", FolderLock::Mode::alone);
  std::error_code error;
  if (fs::file_size(path_ / kRunList, error) == 0) return begin();  // the lock has just made it
  const RunList list = RunList::read(path_);
  for (const auto& [mark, name] : {std::pair{kStudy, "study"}, {kCalibration, "calibration"}})
    if (list.holds(mark))
      throw input_error(path_.string(), "--out", "holds a {}, expected a run's folder to overwrite, or a new one",
                        name);
  require_no_links(false);
  take_back(path_);
  set_aside_ = set_aside(path_, reads);
  begun_ = true;
}

/// Takes back what was set aside in a folder that may not be a run's, since all of its files may be set aside.
void RunDirectory::take_back_of_killed() {
  std::error_code error;
  if (!fs::is_directory(path_, error) || !has_run_list(path_) || !is_set_aside(path_)) return;
  require_writable("");
  lock_ = FolderLock(path_, "", FolderLock::Mode::alone);
  take_back(path_);
}

void RunDirectory::replace() {
  set_aside_ = set_aside(path_);
  begun_ = true;
  existing_ = !set_aside_;
}

bool RunDirectory::replaces() const { return set_aside_ && !came_to_be(path_); }

RunDirectory::~RunDirectory() {
  if (!set_aside_ || !lock_.stands()) return;
  try {
    if (replaces())
      discard();
    else
      drop_aside(path_);
  } catch (const std::exception&) {
    // The next run that takes the folder removes the rest.
  }
}

void RunDirectory::discard() {
  if (existing_) return;
  std::error_code error;
  if (lock_.stands()) try {
      if (begun_) remove_results(path_);
      if (std::exchange(set_aside_, false)) put_back(path_);
      if (fresh_) fs::remove(path_ / kRunList, error);
    } catch (const std::exception&) {
      // The rest is in the list.
    }
  begun_ = false;
  if (made_.empty()) return;
  // Removes folders upwards as long as they are empty.
  for (fs::path at = path_; fs::remove(at, error) && at != made_;) at = at.parent_path();
  made_.clear();
}

void require_plain_files(const fs::path& folder) {
  if (!has_run_list(folder)) return;
  std::error_code error;
  for (const std::string& file : RunList::read(folder).find(folder).files) {
    if (file.starts_with("checkpoints/")) continue;
    if (const auto type = fs::symlink_status(folder / file, error).type();
        type != fs::file_type::regular && type != fs::file_type::symlink && type != fs::file_type::not_found)
      throw input_error((folder / file).string(), "", "is not a file, expected one that furrow wrote");
  }
}

void require_run_directory(const fs::path& folder) {
  std::error_code error;
  if (!fs::exists(folder, error))
    throw input_error(folder.string(), "", "does not exist, expected the folder of a run");
  if (!fs::is_directory(folder, error))
    throw input_error(folder.string(), "", "is not a folder, expected the folder of a run");
  if (access(folder.c_str(), R_OK | X_OK) != 0)
    throw input_error(folder.string(), "", "cannot be read: {}, expected the folder of a run", std::strerror(errno));
  if (is_run(folder)) return;
  if (has_run_list(folder) && RunList::read(folder).holds(kCalibration))
    throw input_error(folder.string(), "", "holds a calibration that has not ended; {}", kOthers[0].continued);
  throw input_error(folder.string(), "", "holds no run, expected scenario.json or run.log in it");
}

}  // namespace furrow::launch
