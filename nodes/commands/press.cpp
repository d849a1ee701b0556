// `furrow press`: a tire of a scenario against a plate or a cleat.
#include <cmath>
#include <cstdio>
#include <iostream>

#include <fmt/format.h>

#include "nodes/commands/commands.hpp"
#include "nodes/launch/messages.hpp"
#include "nodes/launch/progress.hpp"
#include "nodes/launch/run_directory.hpp"
#include "nodes/launch/signals.hpp"
#include "nodes/scenario/scenario.hpp"
#include "protocol/core/clock.hpp"
#include "protocol/files/digits.hpp"
#include "protocol/files/text_file.hpp"
#include "tire/press.hpp"

namespace furrow::commands {
namespace {

constexpr int kFormatVersion = 1;

tire::PressOptions press_options(const PressArguments& arguments) {
  const auto require = [](bool ok, const char* key, const std::string& what) {
    if (!ok) throw input_error("command line", key, what);
  };
  require(arguments.obstacle == "plate" || arguments.obstacle == "cleat" || arguments.obstacle == "profile",
          "--on", "is '" + arguments.obstacle + "', expected plate, cleat or profile");
  const bool profile = arguments.obstacle == "profile";
  require(!profile || !arguments.profile.empty(), "--profile",
          "is missing, expected a CSV file for --on profile");
  require(profile || arguments.profile.empty(), "--profile",
          "is given for --on " + arguments.obstacle + ", expected it for --on profile alone");
  require(arguments.deflection > 0.0 && arguments.deflection <= 0.2, "--deflection",
          "expected above 0 up to 0.2 m");
  require(arguments.points >= 1 && arguments.points <= 1000, "--points", "expected 1 to 1000");
  require(arguments.load > 0.0 && std::isfinite(arguments.load), "--load", "expected above 0 N");
  require(arguments.cleat_height > 0.0 && arguments.cleat_height <= 0.2, "--cleat-height",
          "expected above 0 up to 0.2 m");
  require(arguments.cleat_width > 0.0 && arguments.cleat_width <= 1.0, "--cleat-width",
          "expected above 0 up to 1 m");
  require(std::abs(arguments.cleat_position) <= 1.0, "--cleat-position", "expected -1 to 1 m");
  tire::PressOptions o;
  if (arguments.obstacle == "cleat")
    o.obstacle.height = arguments.cleat_height, o.obstacle.width = arguments.cleat_width,
    o.obstacle.position = arguments.cleat_position;
  if (!arguments.profile.empty()) o.obstacle.profile = tire::read_press_profile(arguments.profile);
  o.deflection = arguments.deflection;
  o.points = arguments.points;
  o.load = arguments.load;
  return o;
}

std::unique_ptr<tire::StaticTest> static_test(const scenario::Scenario& scenario) {
  const tire::TireSpec& tire = *scenario.tires.front();
  std::unique_ptr<tire::StaticTest> test = tire.static_test();
  if (test) return test;
  throw input_error(scenario.file.string(), "tire",
                    fmt::format("is a {} tire, which cannot be pressed, expected a model that deflects, with "
                                "tire.rigid false",
                                tire.describe().name));
}

/// The answer in a line, from the summary; empty where the load was not reached.
std::string result_line(const nlohmann::ordered_json& summary) {
  if (summary["deflection_m"].is_null()) return "";
  const auto in = [](const nlohmann::ordered_json& value, double unit) {
    return digits(value.get<double>() / unit);
  };
  const auto& footprint = summary["footprint"];
  return fmt::format(
      "furrow: a load of {} N deflects the tire by {} mm: secant stiffness {} kN/m, footprint {} mm long{}\n",
      in(summary["load_N"], 1.0), in(summary["deflection_m"], 1e-3),
      in(summary["secant_stiffness_N_per_m"], 1e3), in(footprint["length_m"], 1e-3),
      footprint["width_m"].is_number() ? fmt::format(", {} mm wide", in(footprint["width_m"], 1e-3)) : "");
}

}  // namespace

ExitCode press_command(const scenario::Scenario& scenario, const PressArguments& arguments) {
  const std::unique_ptr<tire::StaticTest> test = static_test(scenario);
  const tire::PressOptions options = press_options(arguments);
  launch::RunDirectory directory(scenario.name + "-press", arguments.out, arguments.overwrite);
  launch::catch_stop_signals();
  try {
    launch::ProgressDisplay display;
    const double begin = wall_clock();
    const tire::PressResults results = test->press(options, [&](const std::string& what, double share) {
      if (launch::stop_signalled()) throw Error(ExitCode::stopped, "stopped by a signal during pressing");
      display.show({.phase = what, .share = share});
    });
    display.clear();
    nlohmann::ordered_json summary = {{"format_version", kFormatVersion},
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
      print_warning(caution + "; see summary.json and tire/README.md, \"Static pressing\"");
    if (summary["deflection_m"].is_null())
      print_warning(fmt::format(
          "the load of {:g} N was not reached: the largest force is {:.4g} N; no stiffness is given, and the "
          "footprint is that of this force; press further (--deflection) or ask for less (--load); see "
          "tire/README.md, \"Static pressing\"",
          options.load, results.at_load.force));
    launch::say(result_line(summary));
    std::cout << directory.path().string() << std::endl;
  } catch (...) {
    directory.discard();
    throw;
  }
  make_report_or_warn(directory.path());
  return ExitCode::done;
}

}  // namespace furrow::commands
