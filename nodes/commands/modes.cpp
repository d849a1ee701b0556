// `furrow modes`: natural frequencies of a tire on a rim at rest.
#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "nodes/commands/command_table.hpp"
#include "nodes/launch/messages.hpp"
#include "nodes/launch/progress.hpp"
#include "nodes/launch/run_directory.hpp"
#include "nodes/launch/signals.hpp"
#include "protocol/files/data_files.hpp"
#include "protocol/files/digits.hpp"
#include "protocol/files/text_file.hpp"
#include "tire/modes.hpp"
#include "tire/tires.hpp"

namespace furrow::commands {
namespace {

constexpr int kModesVersion = 1;
constexpr int kMostAround = 2000, kMostAcross = 400;
constexpr double kMostPressure = 1e8;  // Pa

struct ModesArguments {
  std::string tire;           // file, as given or in tire/data/
  std::filesystem::path out;  // empty: a new folder under results/
  bool overwrite = false;
  bool plots = true;
  bool csv = false, json = false;     // print instead of making a folder
  std::optional<int> orders;          // highest circumferential order; none: 8, or half of the elements around
  std::optional<int> count;           // frequencies of each order; none: 3, or the unknowns of a section
  std::optional<double> pressure;     // gauge, Pa; none: the file's
  std::optional<int> around, across;  // elements; none: the file's
};

Error refused(const char* option, const std::string& what) { return input_error("command line", option, what); }

std::unique_ptr<tire::TireSpec> tire_of(const ModesArguments& arguments) {
  tire::TireOptions options;
  options.file = find_file(arguments.tire, "TIRE", "command line");
  if (arguments.pressure) {
    if (!(*arguments.pressure >= 0.0 && *arguments.pressure <= kMostPressure))
      throw refused("--pressure", fmt::format("is {:g}, expected 0 to {:g} Pa", *arguments.pressure, kMostPressure));
    options.pressure.knots = {{0.0, *arguments.pressure}};
  }
  const auto elements = [](const char* option, const std::optional<int>& value, int most) {
    if (value && (*value < 1 || *value > most))
      throw refused(option, fmt::format("is {}, expected 1 to {}", *value, most));
    return value.value_or(0);
  };
  options.elements_circumference = elements("--elements-circumference", arguments.around, kMostAround);
  options.elements_width = elements("--elements-width", arguments.across, kMostAcross);
  std::unique_ptr<tire::TireSpec> spec = tire::read_tire(options);
  for (const std::string& key : tire::idle_keys(*spec)) {
    std::string option = "--" + key;
    std::replace(option.begin(), option.end(), '_', '-');
    throw refused(option.c_str(), "is given, but a " + spec->describe().name + " does not use it");
  }
  return spec;
}

tire::ModesOptions modes_options(const ModesArguments& arguments, const tire::ModalTest& test) {
  const int most = test.sections() / 2;
  const tire::ModesOptions options{arguments.orders.value_or(std::min(tire::ModesOptions{}.orders, most)),
                                   arguments.count.value_or(std::min(tire::ModesOptions{}.count, test.unknowns()))};
  if (options.orders < 0 || options.orders > most)
    throw refused("--orders",
                  fmt::format("is {}, expected 0 to {}, half of the elements around", options.orders, most));
  if (options.count < 1 || options.count > test.unknowns())
    throw refused("--count",
                  fmt::format("is {}, expected 1 to {}, the unknowns of a section", options.count, test.unknowns()));
  return options;
}

tire::ModesResults compute(const tire::ModalTest& test, const tire::ModesOptions& options) {
  launch::catch_stop_signals();
  launch::ProgressDisplay display;
  tire::ModesResults results = test.modes(options, launch::shown_on(display, " during {}"));
  display.clear();
  return results;
}

/// The lowest frequency of all in one line, or the instability.
std::string result_line(const tire::ModesResults& results) {
  const auto lowest = std::ranges::min_element(results.modes, {}, &tire::Mode::frequency);
  return fmt::format("furrow: lowest frequency {} Hz, of order {}\n", digits(lowest->frequency), lowest->order);
}

void warn_of_unstable(const tire::ModesResults& results) {
  const auto unstable = [](const tire::Mode& mode) { return mode.frequency < 0.0; };
  const auto first = std::ranges::find_if(results.modes, unstable);
  if (first == results.modes.end()) return;
  print_warning(
      "this tire is not stable at rest from order {} on, as computed: {} of {} frequencies are negative, "
      "growth rates over 2π of wrinkles; see scripts/docs/tire_models.md, \"Natural frequencies\"",
      first->order, std::ranges::count_if(results.modes, unstable), results.modes.size());
}

ExitCode modes(const ModesArguments& arguments) {
  const std::unique_ptr<tire::TireSpec> spec = tire_of(arguments);
  const std::unique_ptr<tire::ModalTest> test = spec->modal_test();
  if (!test)
    throw refused(
        "TIRE",
        fmt::format(
            "is '{}', a {} tire: it has no masses that vibrate; expected a shell, a flexible ring or a planar tire",
            spec->options().file.filename().string(), spec->describe().name));
  const tire::ModesOptions options = modes_options(arguments, *test);
  const tire::ModesResults results = compute(*test, options);
  warn_of_unstable(results);
  if (arguments.csv) {
    std::cout << tire::modes_csv(results);
    return ExitCode::done;
  }
  nlohmann::ordered_json summary = {{"format_version", kModesVersion},
                                    {"version", FURROW_VERSION},
                                    {"tire", spec->options().file.filename().string()},
                                    {"details", spec->describe().details}};
  summary.update(tire::modes_json(results));
  if (arguments.json) {
    std::cout << summary.dump(2) << "\n";
    return ExitCode::done;
  }
  launch::RunDirectory directory(spec->options().file.stem().string() + "-modes", arguments.out, arguments.overwrite);
  try {
    directory.add({"modes.csv", "section.csv", "shapes.csv", "summary.json"});
    tire::write_mode_tables(directory.path(), results);
    write_whole_file(directory.path() / "summary.json", summary.dump(2) + "\n");
  } catch (...) {
    directory.discard();
    throw;
  }
  launch::say(result_line(results));
  std::cout << directory.path().string() << std::endl;
  if (arguments.plots) make_report_or_warn(directory.path());
  return ExitCode::done;
}

Action add_modes_options(CLI::App& command, Typed&) {
  const auto arguments = std::make_shared<ModesArguments>();
  command.add_option("TIRE", arguments->tire, "Read this tire file (JSON), as given or in tire/data/.")->required();
  CLI::Option* out = add_folder_options(command, arguments->out, arguments->overwrite, "<tire>-modes-NNN");
  command.add_option("--orders", arguments->orders,
                     "Compute circumferential orders from 0 to this one (default: 8, or half of the elements around).");
  command.add_option(
      "--count", arguments->count,
      "Compute this number of frequencies of each order (default: 3, or all that a section of the tire has).");
  command.add_option("--pressure", arguments->pressure,
                     "Set the inflation pressure (gauge), Pa (default: the file's).");
  command.add_option("--elements-circumference", arguments->around,
                     "Set the number of elements around the tire (default: the file's).");
  command.add_option("--elements-width", arguments->across,
                     "Set the number of elements across the tire (default: the file's).");
  add_no_plots(command, arguments->plots);
  CLI::Option* csv =
      command.add_flag("--csv", arguments->csv, "Print the frequencies as CSV and make no folder.")->excludes(out);
  command.add_flag("--json", arguments->json, "Print the frequencies as JSON and make no folder.")
      ->excludes(out)
      ->excludes(csv);
  return [arguments] { return modes(*arguments); };
}

}  // namespace

Command modes_entry() {
  return {.name = "modes",
          .task = task::test,
          .purpose =
              "Compute the lowest natural frequencies of a tire on a rim at rest, by circumferential order, and print "
              "the folder of the results.",
          .options = add_modes_options,
          .examples = {{"modes hmmwv_lumped.json --orders 3", "Get the frequencies of the lowest orders."}}};
}

}  // namespace furrow::commands
