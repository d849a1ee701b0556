#include "nodes/commands/typed.hpp"

#include <cmath>
#include <cstdlib>

#include "nodes/scenario/load_scenario.hpp"
#include "protocol/files/printable.hpp"

namespace furrow::commands {

void add_settings(CLI::App& command, Typed& typed) {
  command
      .add_option("--set", typed.settings,
                  "Set a scenario key by its dotted path, as key=value. The option may be repeated.")
      ->take_all()
      ->allow_extra_args(false);
  command.add_option("--threads", typed.threads,
                     "Compute the terrain with this number of threads, or with 'auto' (run.threads).");
}

void add_scenario(CLI::App& command, Typed& typed) {
  command.add_option("SCENARIO", typed.scenario, "Read this scenario file (JSON), as given or in rigs/.")->required();
  add_settings(command, typed);
}

Settings settings_of(const Typed& typed) {
  Settings settings;
  for (const std::string& text : typed.settings) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0)
      throw input_error("command line", "--set", "is '" + excerpt(text) + "', expected the form key=value");
    settings.emplace_back(text.substr(0, equals), text.substr(equals + 1));
  }
  const auto add = [&](const char* option, const std::string& value, const char* key) {
    if (value.empty()) return;
    for (const auto& [other, unused] : settings)
      if (other == key) throw input_error("command line", option, "is given with --set {}, expected one of them", key);
    settings.emplace_back(key, value);
  };
  add("--threads", typed.threads, "run.threads");
  add("--until", typed.until, "run.end");
  return settings;
}

scenario::Scenario load(Typed& typed, scenario::Purpose purpose) {
  scenario::Scenario scenario = scenario::load_scenario(typed.scenario, settings_of(typed), purpose);
  typed.memory = scenario.memory.all;
  for (const std::string& warning : scenario.warnings) print_warning(warning);
  return scenario;
}

CLI::Option* add_folder_options(CLI::App& command, std::filesystem::path& out, bool& overwrite,
                                const std::string& usual) {
  CLI::Option* option =
      command.add_option("--out", out, "Write the results to this new folder (default: results/" + usual + ").");
  command.add_flag("--overwrite", overwrite, "Replace the results of an earlier run in the folder of --out.");
  return option;
}

void add_no_plots(CLI::App& command, bool& plots) {
  command.add_flag_callback(
      "--no-plots", [&plots] { plots = false; }, "Make no plots; 'furrow report' makes them later.");
}

CLI::Validator above_zero() {
  const auto problem = [](const std::string& text) -> std::string {
    const double value = std::strtod(text.c_str(), nullptr);
    return std::isfinite(value) && value > 0.0 ? "" : "is " + excerpt(text) + ", expected a number above 0";
  };
  return {problem, "POSITIVE"};
}

}  // namespace furrow::commands
