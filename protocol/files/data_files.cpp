#include "protocol/files/data_files.hpp"

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "protocol/core/error.hpp"
#include "protocol/files/nearest_words.hpp"
#include "protocol/files/printable.hpp"

namespace furrow {
namespace {

constexpr std::size_t kMaxPath = 4095;  // bytes: PATH_MAX
constexpr std::size_t kMaxName = 255;   // bytes: NAME_MAX

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
  return FURROW_SOURCE_FOLDER;  // of the build: programs run from another build folder
}

std::filesystem::path named_file(const std::filesystem::path& name, const std::vector<std::string>& folders) {
  std::error_code error;
  if (name.empty() || name.has_parent_path() || std::filesystem::exists(name, error)) return name;
  std::vector<std::string> known;
  for (const std::string& folder : folders) {
    const std::filesystem::path place = data_folder() / folder;
    if (std::filesystem::is_regular_file(place / name, error)) return place / name;
    for (const auto& entry : std::filesystem::directory_iterator(place, error))
      if (entry.path().extension() == ".json") known.push_back(entry.path().filename().string());
  }
  std::sort(known.begin(), known.end());
  const std::string typed = name.string(), whole = typed + ".json";
  const bool short_of = std::find(known.begin(), known.end(), whole) != known.end();
  const std::vector<std::string> similar = short_of ? std::vector{whole} : nearest_words(typed, known);
  if (similar.empty() || typed.size() > kMaxName) return name;
  throw input_error(typed, "", "does not exist, expected '" + similar.front() + "'?");
}

std::filesystem::path find_file(const std::string& name, const std::string& key,
                                const std::filesystem::path& scenario) {
  // A zero byte would end the name for the system, and a path that long is none.
  if (name.size() > kMaxPath || printable(name) != name)
    throw input_error(scenario.string(), key, "is '" + excerpt(name) + "', expected the name of a file");
  const std::filesystem::path given(name);
  std::vector<std::filesystem::path> places;
  if (given.is_absolute()) {
    places = {given};
  } else {
    const std::filesystem::path data = data_folder();
    places = {scenario.parent_path() / given, data / "rigs" / given, data / "tire" / "data" / given,
              data / "terrain" / "data" / given, data / "vehicle" / "data" / given};
  }
  std::error_code error;
  for (const auto& place : places)
    if (std::filesystem::is_regular_file(place, error)) return place;
  for (const auto& place : places)
    if (std::filesystem::exists(place, error))
      throw input_error(scenario.string(), key,
                        "'" + place.string() + "' is not a regular file, expected one");
  std::vector<std::filesystem::path> looked;
  std::string list;
  for (const auto& place : places) {
    looked.push_back(std::filesystem::absolute(place, error).lexically_normal());
    if (std::find(looked.begin(), looked.end() - 1, looked.back()) == looked.end() - 1)
      list += (list.empty() ? "" : ", ") + looked.back().string();
  }
  throw input_error(scenario.string(), key,
                    "'" + name + "' does not exist, expected a file at one of: " + list);
}

}  // namespace furrow
