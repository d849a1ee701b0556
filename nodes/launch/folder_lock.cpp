#include "nodes/launch/folder_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "nodes/launch/left_launcher.hpp"
#include "nodes/launch/messages.hpp"
#include "nodes/launch/run_list.hpp"
#include "protocol/core/clock.hpp"
#include "protocol/core/error.hpp"

namespace furrow::launch {
namespace {

namespace fs = std::filesystem;

constexpr useconds_t kPause = 50000;     // µs between two tries
constexpr std::size_t kMaxNamed = 4;     // processes in a message
constexpr std::size_t kMaxCommand = 60;  // characters of each one's command line

bool same_file(const struct stat& a, const struct stat& b) { return a.st_dev == b.st_dev && a.st_ino == b.st_ino; }

/// "process 4711 (furrow run small.json)".
std::string process_text(pid_t process) {
  std::ifstream in("/proc/" + std::to_string(process) + "/cmdline", std::ios::binary);
  std::string command{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  while (!command.empty() && command.back() == '\0') command.pop_back();
  for (char& c : command)
    if (std::iscntrl(static_cast<unsigned char>(c))) c = ' ';
  if (command.size() > kMaxCommand) command = command.substr(0, kMaxCommand) + "…";
  return fmt::format("process {} ({})", process, command);
}

/// Returns the other processes of this machine that have the file open, as far as this one may see them.
std::vector<pid_t> processes_with(const struct stat& file) {
  std::vector<pid_t> found;
  std::error_code error;
  for (const auto& process : fs::directory_iterator("/proc", error)) {
    const std::string name = process.path().filename().string();
    if (name.find_first_not_of("0123456789") != std::string::npos || name == std::to_string(getpid())) continue;
    std::error_code hidden;
    for (fs::directory_iterator at(process.path() / "fd", hidden), end; !hidden && at != end; at.increment(hidden)) {
      struct stat open_file {};
      if (stat(at->path().c_str(), &open_file) != 0 || !same_file(open_file, file)) continue;
      found.push_back(std::atoi(name.c_str()));
      break;
    }
  }
  return found;
}

std::string holders_text(const struct stat& file) {
  const std::vector<pid_t> holders = processes_with(file);
  if (holders.empty()) return "a process of another user or machine";
  std::vector<std::string> named;
  for (const pid_t process : holders)
    if (named.size() < kMaxNamed) named.push_back(process_text(process));
  const std::size_t more = holders.size() - named.size();
  return fmt::format("{}{}", fmt::join(named, ", "), more > 0 ? fmt::format(" and {} more", more) : "");
}

/// Ends left launchers that keep the folder. @returns false if other processes also keep it, or if there are none
bool end_left_launchers(const struct stat& file) {
  const std::vector<pid_t> holders = processes_with(file);
  if (holders.empty() || !std::ranges::all_of(holders, is_left_launcher)) return false;
  for (const pid_t process : holders) {
    say("furrow: {} did not end although its ranks had; it is killed\n", process_text(process));
    kill(process, SIGKILL);
  }
  return true;
}

Error taken(const fs::path& folder, const std::string& key, const struct stat& list) {
  return input_error(folder.string(), key,
                     "is in use by a run that has not ended: {}; expected another folder, or that they end first",
                     holders_text(list));
}

}  // namespace

FolderLock::FolderLock(const fs::path& folder, const std::string& key, Mode mode, double patience)
    : folder_(folder), key_(key) {
  const fs::path file = folder / kRunList;
  double begin = wall_clock();
  for (bool told = false, ended = false;;) {
    const int flags = mode == Mode::alone ? O_RDWR | O_CREAT : O_RDONLY;
    handle_ = open(file.c_str(), flags | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (handle_ < 0)
      throw io_error(file.string(), fmt::format("cannot be opened to lock it: {}", std::strerror(errno)));
    struct stat list {};
    fstat(handle_, &list);
    const bool own = try_to_take(mode == Mode::alone ? LOCK_EX : LOCK_SH);
    const bool replaced = own && !stands();  // the process that had the folder removed it when it ended
    if (own && !replaced) return;
    close(std::exchange(handle_, -1));
    if (replaced && !fs::exists(folder)) throw io_error(folder.string(), "was removed while it was waited for");
    if (replaced) continue;
    if (mode == Mode::together) throw taken(folder, key, list);
    if (wall_clock() - begin > patience) {
      if (ended || !end_left_launchers(list)) throw taken(folder, key, list);
      ended = true;
      begin = wall_clock();
    }
    if (!told)
      say("furrow: {} is in use by a run that has not ended: {}; waiting for up to {:.0f} s\n", folder.string(),
          holders_text(list), patience);
    told = true;
    usleep(kPause);
  }
}

/// Returns false if another process has the lock. Without locks in the file system, nobody has it.
bool FolderLock::try_to_take(int operation) const {
  while (flock(handle_, operation | LOCK_NB) != 0) {
    if (errno == EINTR) continue;
    if (errno == EWOULDBLOCK) return false;
    if (operation == LOCK_EX)
      say("furrow: warning: {} cannot be locked ({}): make sure that no other run uses it\n", folder_.string(),
          std::strerror(errno));
    break;
  }
  return true;
}

FolderLock::FolderLock(FolderLock&& other) noexcept
    : folder_(std::move(other.folder_)), key_(std::move(other.key_)), handle_(std::exchange(other.handle_, -1)) {}

FolderLock& FolderLock::operator=(FolderLock&& other) noexcept {
  std::swap(folder_, other.folder_);
  std::swap(key_, other.key_);
  std::swap(handle_, other.handle_);
  return *this;
}

FolderLock::~FolderLock() {
  if (handle_ >= 0) close(handle_);
}

void FolderLock::share() {
  if (handle_ < 0 || try_to_take(LOCK_SH)) return;
  struct stat list {};
  fstat(handle_, &list);
  throw taken(folder_, key_, list);
}

bool FolderLock::stands() const {
  struct stat locked {
  }, named{};
  return handle_ >= 0 && fstat(handle_, &locked) == 0 && lstat((folder_ / kRunList).c_str(), &named) == 0 &&
         same_file(locked, named);
}

void wait_until_free(const fs::path& folder) {
  if (!has_run_list(folder)) return;
  try {
    const FolderLock lock(folder, "", FolderLock::Mode::alone);
  } catch (const Error&) {
    // The run that is about to begin there reports this.
  }
}

}  // namespace furrow::launch
