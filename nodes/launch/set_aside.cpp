#include "nodes/launch/set_aside.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "nodes/launch/folder_lock.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/text_file.hpp"

namespace furrow::launch {
namespace {

namespace fs = std::filesystem;

const std::string kAsideFolder = std::string(kAside) + "/";

constexpr std::ptrdiff_t kHeadLines = 2;  // of evaluations.csv, before the first evaluation

/// Files that a command may list before its results: `furrow run` lists these before its ranks are placed.
const std::vector<std::string> kEarly{"run.log", "scenario.json", "summary_failed.json", kAsideFolder};

std::ptrdiff_t lines_in(const fs::path& file) {
  if (!stands(file)) return 0;
  const std::string text = read_whole_file(file);
  return std::count(text.begin(), text.end(), '\n');
}

/// Folders in the list that contain a run with a list of its own.
std::vector<fs::path> runs_in(const fs::path& folder, const RunList& list) {
  std::vector<fs::path> runs;
  for (const std::string& name : list.find(folder).folders)
    if (name != kAside && has_run_list(folder / name)) runs.push_back(folder / name);
  return runs;
}

/// Removes an empty list and its folder.
void remove_if_empty(const fs::path& run) {
  std::error_code error;
  const bool alone = std::distance(fs::directory_iterator(run, error), fs::directory_iterator()) == 1;
  if (!alone) return;
  fs::remove(run / kRunList, error);
  fs::remove(run, error);
}

/// @param to  exists, with the list
void move_listed(const fs::path& from, const fs::path& to, const RunList& list, const std::string& but = "") {
  const RunList::Found found = list.find(from);
  std::error_code error;
  for (auto folder = found.folders.rbegin(); folder != found.folders.rend(); ++folder)
    if (*folder != kAside) fs::create_directory(to / *folder);
  for (const std::string& folder : found.folders) {
    const fs::path run = from / folder;
    if (folder == kAside || !has_run_list(run)) continue;
    const RunList its = RunList::read(run);
    begin_run_list(to / folder, its.forms());
    begin_run_list(run, {});
    move_listed(run, to / folder, its);
    remove_if_empty(run);
  }
  for (const std::string& file : found.files)
    if (file != but) fs::rename(from / file, to / file);
  for (const std::string& folder : found.folders) fs::remove(from / folder, error);  // if it is empty
}

/// @returns whether all files could be moved
bool move_back(const fs::path& from, const fs::path& to) {
  const RunList list = RunList::read(from);
  const RunList::Found found = list.find(from);
  bool whole = true;
  std::error_code error;
  for (auto folder = found.folders.rbegin(); folder != found.folders.rend(); ++folder)
    fs::create_directory(to / *folder, error);
  for (const std::string& file : found.files) {
    fs::rename(from / file, to / file, error);
    whole = whole && !error;
  }
  for (const std::string& folder : found.folders) {
    if (!has_run_list(from / folder)) continue;
    whole = move_back(from / folder, to / folder) && whole;
    if (whole) begin_run_list(to / folder, RunList::read(from / folder).forms());
  }
  return whole;
}

}  // namespace

bool came_to_be(const fs::path& folder) {
  const RunList list = RunList::read(folder);
  if (list.holds(kCalibration))
    return stands(folder / kCalibration) || lines_in(folder / "evaluations.csv") > kHeadLines;
  if (list.holds(kStudy)) {
    const std::vector<fs::path> runs = runs_in(folder, list);
    return std::any_of(runs.begin(), runs.end(), came_to_be);
  }
  if (list.holds("results.h5")) return list.holds(kBegun);
  return std::any_of(list.forms().begin(), list.forms().end(), [](const std::string& name) {
    return std::find(kEarly.begin(), kEarly.end(), name) == kEarly.end();
  });
}

bool is_set_aside(const fs::path& folder) { return stands(folder / kAside); }

bool set_aside(const fs::path& folder, const fs::path& reads) {
  const fs::path aside = folder / kAside;
  bool done = false;
  const auto as_it_was = [&] {
    if (done) put_back(folder);
  };
  try {
    const RunList list = RunList::read(folder);
    for (const fs::path& run : runs_in(folder, list)) {
      wait_until_free(run);  // ranks outlive a killed supervisor by a second or two
      take_back(run);
    }
    const RunList::Found found = list.find(folder);
    const std::string read_there =
        reads.empty() ? "" : fs::weakly_canonical(reads).lexically_relative(fs::canonical(folder)).string();
    const bool kept = std::find(found.files.begin(), found.files.end(), read_there) != found.files.end();
    std::vector<std::string> names;
    if (!found.files.empty() || !runs_in(folder, list).empty()) {
      names.push_back(kAsideFolder);
      add_to_run_list(folder, names);
      fs::create_directory(aside);
      done = true;
      begin_run_list(aside, list.forms());
    }
    if (kept) {
      write_whole_file(aside / read_there, read_whole_file(folder / read_there));
      names.push_back(read_there);
    }
    begin_run_list(folder, names);
    if (done) move_listed(folder, aside, list, kept ? read_there : "");
    return done;
  } catch (const fs::filesystem_error& failure) {
    as_it_was();
    throw input_error(folder.string(), "--out",
                      "cannot be cleared (" + failure.code().message() + "), expected a folder to write");
  } catch (const Error&) {
    as_it_was();
    throw;
  }
}

void take_back(const fs::path& folder) {
  if (!is_set_aside(folder)) return;
  if (!RunList::read(folder).holds(kAsideFolder))
    throw input_error((folder / kAside).string(), "",
                      "stands where results are to be set aside, expected it elsewhere");
  if (came_to_be(folder)) return drop_aside(folder);
  remove_results(folder);
  put_back(folder);
}

void remove_results(const fs::path& folder) {
  const RunList list = RunList::read(folder);
  for (const fs::path& run : runs_in(folder, list)) {
    remove_listed(run, RunList::read(run));
    begin_run_list(run, {});
    remove_if_empty(run);
  }
  remove_listed(folder, list);
}

void put_back(const fs::path& folder) {
  const fs::path aside = folder / kAside;
  const RunList before = has_run_list(aside) ? RunList::read(aside) : RunList();
  if (!before.forms().empty()) {  // otherwise nothing was moved yet
    begin_run_list(folder, {kAsideFolder});
    if (!move_back(aside, folder)) return;
    begin_run_list(folder, before.forms());
  }
  drop_aside(folder);
}

void drop_aside(const fs::path& folder) {
  const fs::path aside = folder / kAside;
  std::error_code error;
  if (has_run_list(aside)) {
    remove_results(aside);
    fs::remove(aside / kRunList, error);
  }
  fs::remove(aside, error);
}

}  // namespace furrow::launch
