// `furrow press`: a tire of a scenario against a plate or a cleat.
#include <cmath>
#include <iostream>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "nodes/commands/command_table.hpp"
#include "nodes/launch/messages.hpp"
#include "nodes/launch/progress.hpp"
#include "nodes/launch/run_directory.hpp"
#include "nodes/launch/signals.hpp"
#include "nodes/scenario/scenario.hpp"
#include "nodes/scenario/wheel_scales.hpp"
#include "protocol/core/clock.hpp"
#include "protocol/files/digits.hpp"
#include "protocol/files/text_file.hpp"
#include "tire/press/press.hpp"

namespace furrow::commands {
namespace {

constexpr int kPressVersion = 1;
constexpr double kMostCamber = 0.7;  // rad, same as the rig's limit

/// Options that are not given have the values of the scenario's section `press`.
struct PressArguments {
  std::filesystem::path out;  // empty: a new folder under results/
  bool overwrite = false, plots = true;
  std::optional<std::string> on;                    // plate | cleat | profile
  std::filesystem::path profile;                    // CSV; empty: none
  std::optional<double> deflection;                 // largest, m
  std::optional<int> points;                        // of the curve up to it
  std::optional<double> load;                       // of the footprint, N
  std::optional<double> camber;                     // rad
  std::optional<double> cleat_height, cleat_width;  // m
  std::optional<double> cleat_position;             // of its middle, forward of the axle, m
};

/// An option overrides the scenario's key; the schema has checked the key.
tire::PressOptions press_options(const scenario::Scenario& scenario, const PressArguments& arguments) {
  const scenario::PressKeys& keys = scenario.press;
  const std::string on = arguments.on.value_or(keys.on);
  require_option(on == "plate" || on == "cleat" || on == "profile", "--on",
                 "is '" + on + "', expected plate, cleat or profile");
  const bool profile = on == "profile";
  require_option(!profile || !arguments.profile.empty(), "--profile",
                 "is missing, expected a CSV file for --on profile");
  require_option(profile || arguments.profile.empty(), "--profile",
                 "is given for --on " + on + ", expected it for --on profile alone");
  const auto of_cleat = [&](const std::optional<double>& given, const char* key) {
    require_option(!given || on == "cleat", key, "is given for --on " + on + ", expected it for --on cleat alone");
  };
  of_cleat(arguments.cleat_height, "--cleat-height");
  of_cleat(arguments.cleat_width, "--cleat-width");
  of_cleat(arguments.cleat_position, "--cleat-position");
  tire::PressOptions o;
  o.deflection = arguments.deflection.value_or(keys.deflection);
  o.points = arguments.points.value_or(keys.points);
  o.load = arguments.load.value_or(keys.load < 0.0 ? scenario::wheel_loads(scenario).front() : keys.load);
  o.partial = true;
  o.obstacle.camber = arguments.camber.value_or(keys.camber);
  const double height = arguments.cleat_height.value_or(keys.cleat_height),
               width = arguments.cleat_width.value_or(keys.cleat_width),
               position = arguments.cleat_position.value_or(keys.cleat_position);
  const auto within = [](bool is, const char* key, double value, const char* range) {
    require_option(is, key, fmt::format("is {:g}, expected {}", value, range));
  };
  within(o.deflection > 0.0 && o.deflection <= 0.2, "--deflection", o.deflection, "above 0 up to 0.2 m");
  within(o.points >= 1 && o.points <= 1000, "--points", o.points, "1 to 1000");
  within(o.load > 0.0 && std::isfinite(o.load), "--load", o.load, "above 0 N");
  within(std::abs(o.obstacle.camber) <= kMostCamber, "--camber", o.obstacle.camber, "-0.7 to 0.7 rad");
  within(height > 0.0 && height <= 0.2, "--cleat-height", height, "above 0 up to 0.2 m");
  within(width > 0.0 && width <= 1.0, "--cleat-width", width, "above 0 up to 1 m");
  within(std::abs(position) <= 1.0, "--cleat-position", position, "-1 to 1 m");
  if (on == "cleat") o.obstacle.height = height, o.obstacle.width = width, o.obstacle.position = position;
  if (profile) o.obstacle.profile = tire::read_press_profile(arguments.profile);
  if (!arguments.deflection) o.deflection_from = scenario.file.string(), o.deflection_key = "press.deflection";
  if (!arguments.camber) o.camber_from = scenario.file.string(), o.camber_key = "press.camber";
  return o;
}

std::unique_ptr<tire::StaticTest> static_test(const scenario::Scenario& scenario) {
  const tire::TireSpec& tire = *scenario.tires.front();
  std::unique_ptr<tire::StaticTest> test = tire.static_test();
  if (test) return test;
  throw input_error(scenario.file.string(), "tire",
                    "is a {} tire, which cannot be pressed, expected a model that deflects, with tire.rigid false",
                    tire.describe().name);
}

/// The result in one line, from the summary; empty if the load was not reached.
std::string result_line(const nlohmann::ordered_json& summary) {
  if (summary["deflection_m"].is_null()) return "";
  const auto in = [](const nlohmann::ordered_json& value, double unit) { return digits(value.get<double>() / unit); };
  const auto& footprint = summary["footprint"];
  std::string patch;
  if (footprint["length_m"].is_number()) patch = fmt::format(", footprint {} mm long", in(footprint["length_m"], 1e-3));
  if (footprint["width_m"].is_number()) patch += fmt::format(", {} mm wide", in(footprint["width_m"], 1e-3));
  return fmt::format("furrow: a load of {} N deflects the tire by {} mm: secant stiffness {} kN/m{}\n",
                     in(summary["load_N"], 1.0), in(summary["deflection_m"], 1e-3),
                     in(summary["secant_stiffness_N_per_m"], 1e3), patch);
}

std::string not_reached(const tire::PressOptions& options, const tire::PressResults& results) {
  if (results.at_load.force == 0.0)
    return fmt::format(
        "within a deflection of {:g} m the tire touches nothing: no stiffness and no footprint is given; press further "
        "(--deflection){}",
        options.deflection,
        options.obstacle.position != 0.0 ? ", or move the cleat nearer to the middle (--cleat-position)" : "");
  return fmt::format(
      "the load of {:g} N was not reached: the largest force is {:.4g} N; no stiffness is given, and the footprint is "
      "that of this force; press further (--deflection) or ask for less (--load); see "
      "scripts/docs/tire_models.md, \"Static pressing\"",
      options.load, results.at_load.force);
}

ExitCode press(const scenario::Scenario& scenario, const PressArguments& arguments) {
  const std::unique_ptr<tire::StaticTest> test = static_test(scenario);
  const tire::PressOptions options = press_options(scenario, arguments);
  const tire::PressureSchedule& pressure = scenario.tires.front()->options().pressure;
  if (pressure.varies())
    print_warning("tire.pressure changes in time: the tire is pressed at that of t = 0, {:g} Pa", pressure.at(0.0));
  launch::RunDirectory directory(scenario.name + "-press", arguments.out, arguments.overwrite);
  launch::catch_stop_signals();
  std::string ended;
  try {
    launch::ProgressDisplay display;
    const double begin = wall_clock();
    const tire::PressResults results = test->press(options, launch::shown_on(display, " during pressing"));
    display.clear();
    nlohmann::ordered_json summary = {{"format_version", kPressVersion},
                                      {"version", FURROW_VERSION},
                                      {"scenario", scenario.name},
                                      {"tire", scenario.tires.front()->options().file.filename().string()}};
    summary.update(tire::press_json(options, results));
    summary["wall_s"] = wall_clock() - begin;
    directory.add({"scenario.json", "summary.json", "press.csv", "footprint.csv"});
    write_whole_file(directory.path() / "scenario.json", scenario.completed + "\n");
    tire::write_press_tables(directory.path(), results);
    write_whole_file(directory.path() / "summary.json", summary.dump(2) + "\n");
    if (const std::string caution = tire::press_caution(results); !caution.empty())
      print_warning(caution + "; see summary.json and scripts/docs/tire_models.md, \"Static pressing\"");
    ended = results.ended;
    if (summary["deflection_m"].is_null()) print_warning(not_reached(options, results));
    launch::say(result_line(summary));
    std::cout << directory.path().string() << std::endl;
  } catch (...) {
    directory.discard();
    throw;
  }
  if (arguments.plots) make_report_or_warn(directory.path());
  if (ended.empty()) return ExitCode::done;
  print_error(fmt::format("the curve ends early: {}; what was found is in {}", ended, directory.path().string()));
  return ExitCode::physics;
}

Action add_press_options(CLI::App& command, Typed& typed) {
  const auto arguments = std::make_shared<PressArguments>();
  add_scenario(command, typed);
  add_folder_options(command, arguments->out, arguments->overwrite, "<scenario>-press-NNN");
  command.add_option("--on", arguments->on, "Choose the obstacle: plate, cleat or profile (press.on).");
  command.add_option("--deflection", arguments->deflection, "Press up to this deflection, m (press.deflection).");
  command.add_option("--points", arguments->points,
                     "Compute this number of points of the load–deflection curve (press.points).");
  command.add_option("--load", arguments->load, "Compute the footprint at this load, N (press.load).");
  command.add_option("--camber", arguments->camber,
                     "Tilt the wheel about its forward axis, rad; positive leans the top to the right of travel. Shell "
                     "tires only (press.camber).");
  command.add_option("--cleat-height", arguments->cleat_height, "Set the height of the cleat, m (press.cleat_height).");
  command.add_option("--cleat-width", arguments->cleat_width,
                     "Set the width of the cleat's top along the direction of travel, m (press.cleat_width).");
  command.add_option("--cleat-position", arguments->cleat_position,
                     "Set the position of the cleat's middle, forward of the axle, m (press.cleat_position).");
  command.add_option("--profile", arguments->profile,
                     "Read the ground's profile, seen from the axle, from this CSV file with columns x_m,z_m. It needs "
                     "--on profile and a flexible ring or planar tire.");
  add_no_plots(command, arguments->plots);
  return [arguments, &typed] { return press(load(typed), *arguments); };
}

}  // namespace

Command press_entry() {
  return {.name = "press",
          .task = task::test,
          .purpose =
              "Press the tire of a scenario on a plate, a cleat or a profile, statically, and print the folder of the "
              "results.",
          .options = add_press_options,
          .examples = {{"press rigid_ground.json --load 6000", "Get the load-deflection curve, and a footprint."},
                       {"press cleat_press.json --cleat-height 0.025", "Press the tire on a cleat."}}};
}

}  // namespace furrow::commands
