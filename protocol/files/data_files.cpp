#include "protocol/files/data_files.hpp"

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <utility>
#include <vector>

#include "protocol/core/error.hpp"
#include "protocol/files/nearest_words.hpp"
#include "protocol/files/printable.hpp"

namespace furrow {
namespace {

constexpr std::size_t kMaxPath = 4095;     // bytes: PATH_MAX
constexpr std::size_t kMaxFileName = 255;  // bytes: NAME_MAX
constexpr const char* kFolders[] = {"rigs", "tire/data", "terrain/data", "vehicle/data"};

/// Names of the JSON files in a folder; none if it cannot be read.
void add_names(const std::filesystem::path& folder, std::vector<std::string>& names) {
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error))
    if (entry.path().extension() == ".json") names.push_back(entry.path().filename().string());
}

/// The file of `known` that a name without a file probably means: with ".json" behind it, or of similar spelling.
std::optional<std::string> meant(const std::string& typed, std::vector<std::string> known) {
  if (typed.size() > kMaxFileName) return {};
  std::sort(known.begin(), known.end());
  const std::string whole = std::filesystem::path(typed).has_extension() ? typed : typed + ".json";
  if (std::binary_search(known.begin(), known.end(), whole)) return whole;
  const std::vector<std::string> similar = nearest_words(whole, known);
  return similar.empty() ? std::nullopt : std::optional(similar.front());
}

}  // namespace

std::filesystem::path data_folder() {
  if (const char* home = std::getenv("FURROW_HOME"); home && *home) return home;
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  for (std::filesystem::path folder = program.parent_path(); !error && folder.has_relative_path();
       folder = folder.parent_path()) {
    if (std::filesystem::exists(folder / "rigs" / "scenario.schema.json", error)) return folder;
    if (std::filesystem::exists(folder / "share" / "furrow" / "rigs" / "scenario.schema.json", error))
      return folder / "share" / "furrow";
  }
  return FURROW_SOURCE_FOLDER;  // of the build, for programs that run from another build folder
}

std::filesystem::path named_file(const std::filesystem::path& name, const std::vector<std::string>& folders) {
  std::error_code error;
  if (name.empty() || name.has_parent_path() || std::filesystem::exists(name, error)) return name;
  std::vector<std::string> known;
  for (const std::string& folder : folders) {
    const std::filesystem::path place = data_folder() / folder;
    if (std::filesystem::is_regular_file(place / name, error)) return place / name;
    add_names(place, known);
  }
  for (const char* folder : kFolders)  // a file of another kind, which its reader reports
    if (std::filesystem::is_regular_file(data_folder() / folder / name, error)) return data_folder() / folder / name;
  const std::optional<std::string> other = meant(name.string(), std::move(known));
  if (!other) return name;
  throw input_error(name.string(), "", "does not exist, expected '" + *other + "'?");
}

std::filesystem::path find_file(const std::string& name, const std::string& key,
                                const std::filesystem::path& scenario) {
  // For the system, a zero byte would end the name, and a path this long cannot exist.
  if (name.size() > kMaxPath || printable(name) != name)
    throw input_error(scenario.string(), key, "is '" + excerpt(name) + "', expected the name of a file");
  const std::filesystem::path given(name);
  std::vector<std::filesystem::path> places;
  if (given.is_absolute()) {
    places = {given};
  } else {
    const std::filesystem::path data = data_folder();
    places = {scenario.parent_path() / given};
    for (const char* folder : kFolders) places.push_back(data / folder / given);
  }
  std::error_code error;
  for (const auto& place : places)
    if (std::filesystem::is_regular_file(place, error)) return place;
  for (const auto& place : places)
    if (std::filesystem::exists(place, error))
      throw input_error(scenario.string(), key, "'" + place.string() + "' is not a regular file, expected one");
  std::vector<std::filesystem::path> looked;
  std::vector<std::string> known;
  std::string list;
  for (const auto& place : places) {
    if (!given.has_parent_path()) add_names(place.parent_path(), known);
    looked.push_back(std::filesystem::absolute(place, error).lexically_normal());
    if (std::find(looked.begin(), looked.end() - 1, looked.back()) == looked.end() - 1)
      list += (list.empty() ? "" : ", ") + looked.back().string();
  }
  const std::optional<std::string> other = meant(name, std::move(known));
  throw input_error(scenario.string(), key,
                    "'" + name + "' does not exist, expected a file at one of: " + list +
                        (std::filesystem::exists(given, error)
                             ? "; that in the current folder is not looked at: expected its whole path"
                         : other ? "; did you mean '" + *other + "'?"
                                 : ""));
}

}  // namespace furrow
