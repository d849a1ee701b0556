#include "nodes/launch/run_directory.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <vector>

#include <fmt/format.h>

#include "protocol/core/error.hpp"

namespace furrow::launch {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxNumbers = 100000;

/// What runs leave behind; nothing else is ever removed.
bool is_result(const fs::path& entry) {
  const std::string name = entry.filename().string();
  constexpr std::array<const char*, 12> kNames{
      "scenario.json", "results.h5", "results.xdmf", "run.log",  "profile.json", "report.json",
      "soil.json",     "plate.csv",  "shear.csv",    "cone.csv", "repose.csv",   "soil_estimate.json"};
  return std::find(kNames.begin(), kNames.end(), name) != kNames.end() || name == "frames" ||
         name == "checkpoints" || (name.starts_with("timeseries") && entry.extension() == ".csv") ||
         (name.starts_with("summary") && entry.extension() == ".json") || entry.extension() == ".png";
}

std::vector<fs::path> results_in(const fs::path& folder) {
  std::vector<fs::path> found;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (is_result(entry.path())) found.push_back(entry.path());
  return found;
}

bool is_run(const fs::path& folder) {
  std::error_code error;
  return fs::exists(folder / "run.log", error) || fs::exists(folder / "scenario.json", error) ||
         fs::exists(folder / "sweep.json", error);
}

}  // namespace

RunDirectory::RunDirectory(const std::string& scenario, const fs::path& out, bool overwrite) {
  if (!out.empty()) {
    path_ = out;
    std::error_code error;
    if (!fs::exists(fs::symlink_status(out, error)) && make(out)) {
      lock();
      return;
    }
    if (!fs::is_directory(out, error))
      throw input_error(out.string(), "--out", "exists and is no folder, expected a new folder");
    if (!overwrite)
      throw input_error(out.string(), "--out", "exists already, expected a new folder or --overwrite");
    take_over();
    return;
  }
  for (int number = 1; number < kMaxNumbers; ++number) {
    path_ = fs::path("results") / fmt::format("{}-{:03}", scenario, number);
    std::error_code error;
    if (fs::exists(fs::symlink_status(path_, error))) continue;
    if (make(path_)) {
      lock();
      return;
    }
  }
  throw input_error("results", "", "holds too many runs of " + scenario + ", expected --out");
}

RunDirectory::RunDirectory(const fs::path& existing) : existing_(true), path_(existing) {
  require_run_directory(existing);
  require_writable("");
  lock("");
}

void RunDirectory::require_writable(const std::string& key) const {
  if (access(path_.c_str(), W_OK | X_OK) != 0)
    throw input_error(path_.string(), key, "cannot be written, expected a place that can be written");
}

bool RunDirectory::make(const fs::path& folder) {
  std::vector<fs::path> missing;
  std::error_code error;
  for (fs::path at = folder.lexically_normal(); !at.empty() && !fs::exists(at, error); at = at.parent_path())
    if (at.has_filename()) missing.push_back(at);
  std::reverse(missing.begin(), missing.end());
  for (const fs::path& at : missing) {
    if (mkdir(at.c_str(), 0777) == 0) {
      if (made_.empty()) made_ = at;
      continue;
    }
    const int reason = errno;
    if (reason == EEXIST && at != missing.back()) continue;  // another run made it at the same time
    discard();
    if (reason == EEXIST) return false;
    throw input_error(
        folder.string(), "--out",
        fmt::format("cannot be made ({}), expected a place that can be written", std::strerror(reason)));
  }
  return true;
}

void RunDirectory::take_over() {
  std::error_code error;
  if (!fs::is_empty(path_, error) && !is_run(path_))
    throw input_error(path_.string(), "--out",
                      "holds no run, expected a run's folder to overwrite, or a new one");
  require_writable("--out");
  lock();
  fs::remove_all(aside(), error);
  const std::vector<fs::path> results = results_in(path_);
  if (results.empty()) return;
  set_aside_ = fs::create_directory(aside(), error);
  for (std::size_t i = 0; i < results.size() && !error; ++i)
    fs::rename(results[i], aside() / results[i].filename(), error);
  if (error)
    throw input_error(path_.string(), "--out",
                      "cannot be cleared (" + error.message() + "), expected a folder to write");
}

void RunDirectory::lock(const std::string& key) { folder_ = lock_folder(path_, key); }

RunDirectory::~RunDirectory() {
  std::error_code error;
  if (set_aside_) fs::remove_all(aside(), error);
  if (folder_ >= 0) close(folder_);
}

void RunDirectory::discard() {
  if (existing_) return;
  std::error_code error;
  for (const fs::path& result : results_in(path_)) fs::remove_all(result, error);
  if (set_aside_) {
    for (const auto& entry : fs::directory_iterator(aside(), error))
      fs::rename(entry.path(), path_ / entry.path().filename(), error);
    fs::remove(aside(), error);
    set_aside_ = false;
  }
  if (made_.empty()) return;
  // Upwards as long as nothing else stands there.
  for (fs::path at = path_.lexically_normal(); fs::remove(at, error) && at != made_.lexically_normal();)
    at = at.parent_path();
  made_.clear();
}

int lock_folder(const fs::path& folder, const std::string& key) {
  const int handle = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (handle >= 0 && flock(handle, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    close(handle);
    throw input_error(folder.string(), key, "is taken by a run that is not over, expected another folder");
  }
  return handle;
}

void require_run_directory(const fs::path& folder) {
  std::error_code error;
  if (!fs::exists(folder, error))
    throw input_error(folder.string(), "", "does not exist, expected the folder of a run");
  if (!fs::is_directory(folder, error))
    throw input_error(folder.string(), "", "is no folder, expected the folder of a run");
  if (!is_run(folder))
    throw input_error(folder.string(), "", "holds no run, expected scenario.json or run.log in it");
}

}  // namespace furrow::launch
