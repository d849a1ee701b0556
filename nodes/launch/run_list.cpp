#include "nodes/launch/run_list.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include <fmt/format.h>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/new_file.hpp"
#include "protocol/files/text_file.hpp"

namespace furrow::launch {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kKind = "furrow-run ";
constexpr int kVersion = 1;
constexpr std::size_t kMaxName = 4096;  // bytes
constexpr std::size_t kMaxDigits = 18;  // of a number in a name

std::string head() { return fmt::format("{}{}\n", kKind, kVersion); }

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Removes "%06d" from the beginning of `form`. @returns the least number of digits; 0: it does not begin so
std::size_t take_number(std::string_view& form) {
  std::size_t digits = 0, at = 1;
  while (at < form.size() && at < 4 && is_digit(form[at]))
    digits = 10 * digits + static_cast<std::size_t>(form[at++] - '0');
  if (at == 1 || at >= form.size() || form[at] != 'd') return 0;
  form.remove_prefix(at + 1);
  return std::max<std::size_t>(digits, 1);
}

/// Checks whether it is a path below the folder.
bool is_inside(std::string_view form) {
  if (form.empty() || form.size() > kMaxName || form.front() == '/') return false;
  for (const fs::path& part : fs::path(form))
    if (part == ".." || part == ".") return false;
  return std::none_of(form.begin(), form.end(), [](unsigned char c) { return c < ' '; });
}

/// Adds text to the folder's list, all of it or nothing.
void append(const fs::path& folder, const std::string& text) {
  const fs::path file = folder / kRunList;
  const auto failed = [&](int reason) {
    return io_error(file.string(), fmt::format("cannot be written: {}", std::strerror(reason)));
  };
  const int handle = open(file.c_str(), O_RDWR | O_APPEND | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666);
  if (handle < 0) throw failed(errno);
  std::array<char, kMaxName + 2> end{};
  off_t size = std::max<off_t>(lseek(handle, 0, SEEK_END), 0);
  const off_t from = std::max<off_t>(size - static_cast<off_t>(end.size()), 0);
  const ssize_t count = pread(handle, end.data(), end.size(), from);
  // A line that was cut short by a full disk or a kill is not a name.
  const std::size_t line =
      std::string_view(end.data(), static_cast<std::size_t>(std::max<ssize_t>(count, 0))).rfind('\n');
  const off_t whole = line == std::string_view::npos ? 0 : from + static_cast<off_t>(line) + 1;
  errno = 0;
  bool good = whole == size || ftruncate(handle, whole) == 0;
  size = whole;
  good = good && write(handle, text.data(), text.size()) == static_cast<ssize_t>(text.size()) && fsync(handle) == 0;
  const int reason = errno == 0 ? ENOSPC : errno;  // a write that stops halfway sets no reason
  if (!good && ftruncate(handle, size) != 0) {
    // The cut-short line stays; adding the next line removes it.
  }
  close(handle);
  if (!good) throw failed(reason);
}

std::string lines_of(const std::vector<std::string>& forms) {
  std::string text;
  for (const std::string& form : forms) {
    FURROW_ASSERT(is_inside(form), form);
    text += form + "\n";
  }
  return text;
}

bool is_folder(const fs::directory_entry& entry) {
  std::error_code error;
  return fs::is_directory(entry.symlink_status(error));
}

}  // namespace

bool is_of_form(std::string_view name, std::string_view form, std::int64_t* number) {
  while (!form.empty()) {
    std::size_t least = 0;
    if (form.front() == '%') {
      least = take_number(form);
      if (least == 0) return false;
      const std::size_t count =
          static_cast<std::size_t>(std::find_if_not(name.begin(), name.end(), is_digit) - name.begin());
      if (count < least || count > kMaxDigits || (count > least && name.front() == '0')) return false;
      if (number) *number = std::strtoll(std::string(name.substr(0, count)).c_str(), nullptr, 10);
      name.remove_prefix(count);
      continue;
    }
    if (name.empty() || name.front() != form.front()) return false;
    name.remove_prefix(1);
    form.remove_prefix(1);
  }
  return name.empty();
}

bool stands(const fs::path& at) {
  std::error_code error;
  return fs::exists(fs::symlink_status(at, error));
}

bool has_run_list(const fs::path& folder) {
  std::error_code error;
  return fs::is_regular_file(fs::symlink_status(folder / kRunList, error));
}

RunList RunList::read(const fs::path& folder) {
  const fs::path file = folder / kRunList;
  if (!has_run_list(folder))
    throw input_error(file.string(), "", "is missing or no file, expected a run's list of its files");
  std::error_code error;
  if (fs::file_size(file, error) == 0 && !error) return RunList();  // killed before its first line
  std::string text = read_text_file(file, "a run's list of its files");
  text.resize(text.rfind('\n') == std::string::npos ? 0 : text.rfind('\n') + 1);
  std::vector<std::string> forms;
  bool begun = false;
  for (std::size_t from = 0, to; (to = text.find('\n', from)) != std::string::npos; from = to + 1) {
    const std::string line = text.substr(from, to - from);
    if (line + "\n" == head()) {
      begun = true;
      forms.clear();
      continue;
    }
    if (line.starts_with(kKind))
      throw input_error(file.string(), "", "is of version '{}', expected {}: another version of furrow wrote it",
                        line.substr(kKind.size()), kVersion);
    if (!begun || !is_inside(line))
      throw input_error(file.string() + ":" + place_in_text(text, from), "",
                        begun
                            ? "is not the name of a file below its folder, expected one: the list is damaged"
                            : "is not a list of a run's files, expected '" + head().substr(0, head().size() - 1) + "'");
    forms.push_back(line);
  }
  return RunList(std::move(forms));
}

bool RunList::holds(std::string_view name) const {
  const auto listed = [&](std::string_view n) {
    return std::any_of(forms_.begin(), forms_.end(), [&](const std::string& form) { return is_of_form(n, form); });
  };
  if (listed(name)) return true;
  const std::size_t slash = name.rfind('/') + 1;  // 0: none
  const std::string made = name_in_the_making(name.substr(slash));
  return !made.empty() && listed(std::string(name.substr(0, slash)) + made);
}

RunList::Found RunList::find(const fs::path& folder, const std::string& inside) const {
  Found found;
  std::error_code error;
  const bool linked = fs::is_symlink(fs::symlink_status(folder / inside.substr(0, inside.rfind('/')), error));
  if (inside.empty() || !linked) find(folder, inside, found);
  return found;
}

void RunList::find(const fs::path& folder, const std::string& inside, Found& found) const {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder / inside, error)) {
    const std::string name = inside + entry.path().filename().string();
    if (is_folder(entry)) {
      if (!holds(name + "/")) continue;
      find(folder, name + "/", found);
      found.folders.push_back(name);
    } else if (holds(name)) {
      found.files.push_back(name);
    }
  }
}

void begin_run_list(const fs::path& folder, const std::vector<std::string>& forms) {
  append(folder, head() + lines_of(forms));
  sync_folder(folder);
}

void require_own(const fs::path& folder, const std::vector<std::string>& forms) {
  const RunList before = has_run_list(folder) ? RunList::read(folder) : RunList();
  for (const std::string& name : RunList(forms).find(folder).files)
    if (!before.holds(name))
      throw input_error((folder / name).string(), "",
                        "stands where a result is to be written, and furrow did not write it, expected another place "
                        "for it, or another folder for the results");
}

void add_to_run_list(const fs::path& folder, const std::vector<std::string>& forms) {
  const bool listed = has_run_list(folder);
  const RunList before = listed ? RunList::read(folder) : RunList();
  std::vector<std::string> added;
  for (const std::string& form : forms)
    if (std::find(before.forms().begin(), before.forms().end(), form) == before.forms().end()) added.push_back(form);
  if (added.empty()) return;
  require_own(folder, added);
  std::error_code error;
  const bool headed = listed && fs::file_size(folder / kRunList, error) > 0 && !error;
  append(folder, (headed ? "" : head()) + lines_of(added));
  if (!listed) sync_folder(folder);
}

void remove_listed(const fs::path& folder, const RunList& list, const std::string& inside) {
  const RunList::Found found = list.find(folder, inside);
  std::error_code error;
  for (const auto* names : {&found.files, &found.folders})
    for (const std::string& name : *names) fs::remove(folder / name, error);
}

void remove_unfinished(const fs::path& folder) {
  std::error_code error;
  for (const std::string& name : RunList::read(folder).find(folder).files)
    if (!name_in_the_making(fs::path(name).filename().string()).empty()) fs::remove(folder / name, error);
}

}  // namespace furrow::launch
