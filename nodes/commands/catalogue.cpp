// `furrow list` and `furrow new`: the files that come with the program, and a first scenario.
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "nodes/commands/command_table.hpp"
#include "nodes/commands/wrapped.hpp"
#include "nodes/launch/messages.hpp"
#include "nodes/scenario/rank_table.hpp"
#include "nodes/scenario/starter.hpp"
#include "protocol/files/data_files.hpp"
#include "protocol/files/file_kind.hpp"
#include "protocol/files/json_text.hpp"

namespace furrow::commands {
namespace {

using Json = nlohmann::ordered_json;

struct Kind {
  const char* name;
  const char* folder;
  const char* use;
  FileKind holds;  // files of other kinds in the folder are listed elsewhere
};

struct ListArguments {
  std::string kind;  // empty: all
  bool json = false;
};

struct NewArguments {
  std::filesystem::path name;
  std::string tire, soil, vehicle;  // files; empty: see scenario::StarterOptions
  bool rigid = false;
  std::optional<double> load;  // of the wheel, N
};

constexpr Kind kKinds[] = {
    {"scenarios", "rigs", "furrow run NAME", FileKind::scenario},
    {"studies", "rigs", "furrow sweep NAME", FileKind::study},
    {"calibrations", "rigs", "furrow calibrate NAME", FileKind::calibration},
    {"tires", "tire/data", "tire.file of a scenario", FileKind::tire},
    {"soils", "terrain/data", "terrain.material of a scenario", FileKind::soil},
    {"vehicles", "vehicle/data", "rig.vehicle of a scenario", FileKind::vehicle},
};

/// The first sentence of a text, without its full stop. An initial, as in "J. Y. Wong", does not end a sentence.
std::string first_sentence(const std::string& text) {
  const auto is_initial = [&text](std::size_t letter) {
    return text[letter] >= 'A' && text[letter] <= 'Z' && (letter == 0 || text[letter - 1] == ' ');
  };
  std::size_t end = text.find(". ");
  while (end != std::string::npos && end > 0 && is_initial(end - 1)) end = text.find(". ", end + 1);
  const std::string first = text.substr(0, end);
  return first.ends_with('.') ? first.substr(0, first.size() - 1) : first;
}

/// Describes a file in one sentence, from its own text.
std::string line_of(const Json& file) {
  for (const char* key : {"description", "name"}) {
    if (!file.contains(key) || !file[key].is_string()) continue;
    return first_sentence(file[key]);
  }
  return {};
}

Json catalogue(const std::string& only) {
  Json all = Json::object();
  for (const Kind& kind : kKinds) {
    if (!only.empty() && only != kind.name) continue;
    const std::filesystem::path folder = data_folder() / kind.folder;
    if (!std::filesystem::is_directory(folder))
      throw io_error(folder.string(),
                     "is missing, expected the folder that comes with furrow (FURROW_HOME names the folder above it)");
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      if (entry.path().extension() == ".json" && !entry.path().stem().string().ends_with(".schema"))
        files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    Json& listed = all[kind.name] = {{"folder", folder.string()}, {"use", kind.use}, {"files", Json::object()}};
    for (const std::filesystem::path& path : files)
      if (const Json file = load_json<Json>(path, "a file that comes with furrow"); kind_of_file(file) == kind.holds)
        listed["files"][path.filename().string()] = line_of(file);
  }
  return all;
}

ExitCode list(const ListArguments& arguments) {
  const std::string& only = arguments.kind;
  std::string kinds;
  bool known = only.empty();
  for (const Kind& kind : kKinds) {
    kinds += (kinds.empty() ? "'" : ", '") + std::string(kind.name) + "'";
    known = known || only == kind.name;
  }
  if (!known) throw input_error("command line", "KIND", "is {}, expected one of {}", value_text(Json(only)), kinds);
  const Json all = catalogue(only);
  if (arguments.json) {
    std::cout << all.dump(2) << "\n";
    return ExitCode::done;
  }
  std::string text;
  for (const auto& [kind, listed] : all.items()) {
    text += fmt::format("{}{} ({}) in {}\n", text.empty() ? "" : "\n", kind, listed["use"].get<std::string>(),
                        listed["folder"].get<std::string>());
    for (const auto& [name, line] : listed["files"].items())
      text += fmt::format("  {:<26} {}\n", name, line.get<std::string>());
  }
  print_text(text, Piped::whole_lines);
  return ExitCode::done;
}

ExitCode write_new(const NewArguments& arguments) {
  std::filesystem::path file = arguments.name;
  if (const std::string name = file.filename().string(); name.empty() || name[0] == '-' || name[0] == '.')
    throw input_error("command line", "NAME", "is '" + arguments.name.string() + "', expected a name for a file");
  if (file.extension() != ".json") file += ".json";
  scenario::write_starter(file, {.tire = arguments.tire,
                                 .soil = arguments.soil,
                                 .vehicle = arguments.vehicle,
                                 .rigid = arguments.rigid,
                                 .load = arguments.load.value_or(0.0)});
  std::cout << file.string() << "\n";
  const std::string name = scenario::shell_quoted(file.string());
  launch::say("furrow: '{}' is written; check it with: furrow validate {}; run it with: furrow run {}\n", file.string(),
              name, name);
  return ExitCode::done;
}

Action list_options(CLI::App& command, Typed&) {
  const auto arguments = std::make_shared<ListArguments>();
  command.add_option("KIND", arguments->kind,
                     "List this kind only: scenarios, studies, calibrations, tires, soils or vehicles (default: all).");
  command.add_flag("--json", arguments->json, "Print JSON.");
  return [arguments] { return list(*arguments); };
}

Action new_options(CLI::App& command, Typed&) {
  const auto arguments = std::make_shared<NewArguments>();
  command.add_option("NAME", arguments->name, "Write to this file; .json is added where it is missing.")->required();
  CLI::Option* tire =
      command.add_option("--tire", arguments->tire, "Use this tire file (default: the layered HMMWV tire).");
  command.add_option("--soil", arguments->soil,
                     "Use this soil file; one of empirical soil gives engine scm (default: cohesive grains).");
  command.add_flag("--rigid", arguments->rigid, "Make the tires rigid (tire.rigid).");
  CLI::Option* load =
      command.add_option("--load", arguments->load, "Set the load on the wheel, N (default: by the tire's size).")
          ->check(above_zero());
  command.add_option("--vehicle", arguments->vehicle, "Use this vehicle file: a whole vehicle in place of one wheel.")
      ->excludes(tire)
      ->excludes(load);
  return [arguments] { return write_new(*arguments); };
}

}  // namespace

Command list_entry() {
  return {.name = "list",
          .task = task::begin,
          .purpose = "List the scenarios, studies, calibrations, tires, soils and vehicles that come with Furrow.",
          .options = list_options,
          .examples = {{"list", "See everything that comes with Furrow."},
                       {"list tires --json", "Let a script choose a tire."}},
          .quiet = false};
}

Command new_entry() {
  return {.name = "new",
          .task = task::begin,
          .purpose = "Write a scenario of your own to start from, with a comment for every key, and print its name.",
          .options = new_options,
          .examples = {{"new mine", "Write mine.json: one wheel on cohesive grains."},
                       {"new mine --tire my_tire.json --load 5000", "Give your own tire its load, N."},
                       {"new trip --vehicle hmmwv.json", "Drive a whole vehicle."}}};
}

}  // namespace furrow::commands
