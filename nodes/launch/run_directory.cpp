#include "nodes/launch/run_directory.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include <fmt/format.h>

#include "protocol/core/error.hpp"
#include "protocol/files/text_file.hpp"

namespace furrow::launch {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxNumbers = 100000;
constexpr const char* kAside = ".furrow-before";
constexpr const char* kNoParents = "FURROW_MAKES_NO_PARENTS";
constexpr const char* kStudy = "sweep.json";          // what the list of a study holds
constexpr const char* kKinematics = "kinematics.csv";  // of `furrow kc`
constexpr const char* kModes = "modes.csv";            // of `furrow modes`
constexpr const char* kCalibration = "calibration.json";  // of `furrow calibrate`

Error no_list(const fs::path& folder, const std::string& key, const std::string& why) {
  return input_error(folder.string(), key,
                     fmt::format("holds no run's list of its files ({}): {}", kRunList, why));
}

/// What one command makes, and what the list of its folder holds from the start.
struct Kind {
  const char* mark;
  const char* holds;
  const char* continued;  // by what
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

/// What a run may list before its first step. The ranks list all else when they are placed.
constexpr const char* kEarly[] = {"run.log", "scenario.json", "summary_failed.json"};

/// Whether the run of this list began to step.
bool came_to_be(const RunList& list) {
  return std::any_of(list.forms().begin(), list.forms().end(), [](const std::string& name) {
    return name != std::string(kAside) + "/" &&
           std::find(std::begin(kEarly), std::end(kEarly), name) == std::end(kEarly);
  });
}

/// Without separators at the end. @throws Error(bad_input) for a way through a folder that does not exist
fs::path way_to(const fs::path& out) {
  fs::path way;
  bool missing = false;
  for (const fs::path& part : out) {
    if (part.empty()) continue;
    if (missing && part == "..")
      throw input_error(
          out.string(), "--out",
          "leads through '" + way.string() + "', which does not exist, expected a way without it");
    way /= part;
    std::error_code error;
    missing = missing || !fs::exists(way, error);
  }
  return way;
}

bool stands(const fs::path& at) {
  std::error_code error;
  return fs::exists(fs::symlink_status(at, error));
}

}  // namespace

RunDirectory::RunDirectory(const std::string& scenario, const fs::path& out, bool overwrite,
                           const fs::path& reads) {
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
    if (!made && !overwrite)
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
  if (!has_run_list(path_))
    throw no_list(path_, "",
                  "an earlier version of furrow made it; continue it with that version, or start again with "
                  "furrow run in a new folder");
  require_writable("");
  const RunList list = RunList::read(path_);
  for (const Kind& kind : kOthers)
    if (list.holds(kind.mark))
      throw input_error(path_.string(), "", fmt::format("holds {}, expected a run; {}", kind.holds, kind.continued));
  if (!lock_.stands()) lock_ = FolderLock(path_, "", FolderLock::Mode::alone);
  take_back(RunList::read(path_));  // of who had the folder until now
}

struct RunDirectory::Continued {
  const char* mark;  // a file that its list holds
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
        throw input_error(folder.string(), "--out",
                          fmt::format("exists and is not a folder, expected a new one or that of a {}", kind.name));
      if (!has_run_list(path_) && !fs::is_empty(path_, error))
        throw no_list(
            folder, "--out",
            fmt::format("no {} made it, or an earlier version of furrow did; expected a new or empty folder",
                        kind.name));
      require_writable("--out");
      lock_ = FolderLock(path_, "--out", FolderLock::Mode::alone);
      const RunList list = RunList::read(path_);
      if (!list.forms().empty() && !list.holds(kind.mark))
        throw input_error(folder.string(), "--out",
                          fmt::format("holds a run, expected a new folder or that of a {}", kind.name));
      require_own(path_, files);
      if (overwrite) remove_listed(path_, list);
    }
  } catch (const Error&) {
    discard();
    throw;
  }
  existing_ = true;
}

RunDirectory RunDirectory::of_study(const fs::path& folder) {
  return {Continued{kStudy, "study"}, folder, false, {}};
}

RunDirectory RunDirectory::of_calibration(const fs::path& folder, bool overwrite,
                                          const std::vector<std::string>& files) {
  return {Continued{kCalibration, "calibration"}, folder, overwrite, files};
}

fs::path RunDirectory::aside() const { return path_ / kAside; }

void RunDirectory::require_writable(const std::string& key) const {
  if (access(path_.c_str(), W_OK | X_OK) != 0)
    throw input_error(path_.string(), key, "cannot be written, expected a place that can be written");
}

void make_no_parents() { setenv(kNoParents, "1", 1); }

/// @returns false when it exists by now
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
    throw input_error(
        path_.string(), "--out",
        fmt::format("cannot be made ({}), expected a place that can be written", std::strerror(reason)));
  }
  return true;
}

void RunDirectory::begin() {
  fresh_ = true;
  lock_ = FolderLock(path_, "--out", FolderLock::Mode::alone);
  begin_run_list(path_, {});
  begun_ = true;
}

void RunDirectory::take_over(const fs::path& reads) {
  std::error_code error;
  const bool listed = has_run_list(path_);
  if (!listed && !fs::is_empty(path_, error))
    throw no_list(path_, "--out",
                  "no run made it, or an earlier version of furrow did; expected a new or empty folder (move "
                  "this one away)");
  require_writable("--out");
  if (!listed) return begin();
  lock_ = FolderLock(path_, "--out", FolderLock::Mode::alone);
  const RunList list = RunList::read(path_);
  for (const auto& [mark, name] : {std::pair{kStudy, "study"}, {kCalibration, "calibration"}})
    if (list.holds(mark))
      throw input_error(path_.string(), "--out",
                        fmt::format("holds a {}, expected a run's folder to overwrite, or a new one", name));
  take_back(list);
  set_aside(RunList::read(path_), reads);
}

/// The same in a folder that is not known to hold a run yet: what it holds may all be set aside.
void RunDirectory::take_back_of_killed() {
  std::error_code error;
  if (!fs::is_directory(path_, error) || !has_run_list(path_) || !stands(aside())) return;
  require_writable("");
  lock_ = FolderLock(path_, "", FolderLock::Mode::alone);
  take_back(RunList::read(path_));
}

bool RunDirectory::replaces() const { return set_aside_ && !came_to_be(RunList::read(path_)); }

/// What a run that was killed had set aside: put back unless that run came to be.
void RunDirectory::take_back(const RunList& list) {
  if (!stands(aside())) return;
  if (!list.holds(std::string(kAside) + "/"))
    throw input_error(aside().string(), "",
                      "stands where results are to be set aside, expected it elsewhere");
  if (came_to_be(list)) return drop_aside();
  remove_listed(path_, list);
  put_back();
}

/// Whenever this is cut short, the folder's list says that no run came to be, and the other one what to put back.
void RunDirectory::set_aside(const RunList& list, const fs::path& reads) {
  const RunList::Found found = list.find(path_);
  try {
    const std::string read_there =
        reads.empty() ? "" : fs::weakly_canonical(reads).lexically_relative(fs::canonical(path_)).string();
    const bool kept = std::find(found.files.begin(), found.files.end(), read_there) != found.files.end();
    std::vector<std::string> names;
    if (!found.files.empty()) {
      names.push_back(std::string(kAside) + "/");
      add_to_run_list(path_, names);
      fs::create_directory(aside());
      set_aside_ = true;
      begin_run_list(aside(), list.forms());
    }
    if (kept) {
      write_whole_file(aside() / read_there, read_whole_file(path_ / read_there));
      names.push_back(read_there);
    }
    begin_run_list(path_, names);
    for (auto folder = found.folders.rbegin(); set_aside_ && folder != found.folders.rend(); ++folder)
      fs::create_directory(aside() / *folder);
    for (const std::string& file : found.files)
      if (file != read_there) fs::rename(path_ / file, aside() / file);
    std::error_code error;
    for (const std::string& folder : found.folders) fs::remove(path_ / folder, error);  // where it is empty
    begun_ = true;
  } catch (const fs::filesystem_error& failure) {
    if (set_aside_) put_back();
    throw input_error(path_.string(), "--out",
                      "cannot be cleared (" + failure.code().message() + "), expected a folder to write");
  } catch (const Error&) {
    if (set_aside_) put_back();
    throw;
  }
}

/// What cannot be put back stays set aside, and the list says so.
void RunDirectory::put_back() {
  set_aside_ = false;
  const RunList before = has_run_list(aside()) ? RunList::read(aside()) : RunList();
  if (!before.forms().empty()) {  // else nothing was moved yet
    const RunList::Found found = before.find(aside());
    begin_run_list(path_, {std::string(kAside) + "/"});
    std::error_code error;
    for (auto folder = found.folders.rbegin(); folder != found.folders.rend(); ++folder)
      fs::create_directory(path_ / *folder, error);
    bool whole = true;
    for (const std::string& file : found.files) {
      fs::rename(aside() / file, path_ / file, error);
      whole = whole && !error;
    }
    if (!whole) return;
    begin_run_list(path_, before.forms());
  }
  drop_aside();
}

/// With what is in its list.
void RunDirectory::drop_aside() {
  std::error_code error;
  if (has_run_list(aside())) {
    remove_listed(aside(), RunList::read(aside()));
    fs::remove(aside() / kRunList, error);
  }
  fs::remove(aside(), error);
}

RunDirectory::~RunDirectory() {
  if (!set_aside_ || !lock_.stands()) return;
  try {
    drop_aside();
  } catch (const std::exception&) {
    // What stays is removed by the next run that takes the folder.
  }
}

void RunDirectory::discard() {
  if (existing_) return;
  std::error_code error;
  if (lock_.stands()) try {
      if (begun_) remove_listed(path_, RunList::read(path_));
      if (set_aside_) put_back();
      if (fresh_) fs::remove(path_ / kRunList, error);
    } catch (const std::exception&) {
      // What stays is in the list.
    }
  begun_ = false;
  if (made_.empty()) return;
  // Upwards as long as nothing else stands there.
  for (fs::path at = path_; fs::remove(at, error) && at != made_;) at = at.parent_path();
  made_.clear();
}

void require_run_directory(const fs::path& folder) {
  std::error_code error;
  if (!fs::exists(folder, error))
    throw input_error(folder.string(), "", "does not exist, expected the folder of a run");
  if (!fs::is_directory(folder, error))
    throw input_error(folder.string(), "", "is not a folder, expected the folder of a run");
  if (is_run(folder)) return;
  if (has_run_list(folder) && RunList::read(folder).holds(kCalibration))
    throw input_error(folder.string(), "",
                      fmt::format("holds a calibration that has not ended; {}", kOthers[0].continued));
  throw input_error(folder.string(), "", "holds no run, expected scenario.json or run.log in it");
}

}  // namespace furrow::launch
