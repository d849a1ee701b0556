// `furrow kc` and `furrow validate` of a vehicle: its properties before it drives.
#include <algorithm>
#include <iostream>
#include <memory>

#include <fmt/format.h>

#include "nodes/commands/command_table.hpp"
#include "nodes/commands/wrapped.hpp"
#include "nodes/launch/progress.hpp"
#include "nodes/launch/run_directory.hpp"
#include "nodes/launch/signals.hpp"
#include "nodes/scenario/vehicle_tires.hpp"
#include "protocol/core/clock.hpp"
#include "protocol/files/figures_json.hpp"
#include "protocol/files/json_text.hpp"
#include "protocol/files/text_file.hpp"
#include "vehicle/analysis/kinematics.hpp"
#include "vehicle/spec/read_vehicle.hpp"
#include "vehicle/spec/vehicle_magnitudes.hpp"

namespace furrow::commands {
namespace {

constexpr int kVehicleVersion = 1;
constexpr double kTravelShare = 0.2;  // of the smallest tire's radius
constexpr double kMostTravel = 1.0;   // m
constexpr double kQuiet = 2.0;        // most vehicles come to rest in it; progress is shown later, s
constexpr int kLeastPoints = 3, kMostPoints = 1001;

struct KinematicsArguments {
  std::string vehicle;
  std::filesystem::path out;  // empty: a new folder under results/
  bool overwrite = false;
  bool plots = true;
  bool csv = false, json = false;  // print instead of making a folder
  double travel = 0.0;             // up and down, m; 0: a fifth of the smallest tire's radius
  int points = 21;                 // of each motion
};

void check(const KinematicsArguments& arguments) {
  require_option(arguments.travel >= 0.0 && arguments.travel <= kMostTravel, "--travel",
                 fmt::format("is {}, expected above 0 up to {:g} m, or 0: a fifth of the smallest tire's radius",
                             number_text(arguments.travel), kMostTravel));
  require_option(arguments.points >= kLeastPoints && arguments.points <= kMostPoints, "--points",
                 fmt::format("is {}, expected {} to {}", arguments.points, kLeastPoints, kMostPoints));
}

/// The vehicle on its tires; presses the tires that are not in the cache.
vehicle::VehiclePage stand(const vehicle::VehicleSpec& spec) {
  for (const auto& [key, what] : vehicle::unlikely_values(spec, vehicle::mass_without_tires(spec)))
    print_warning(input_error(spec.file, key, what).what());
  launch::catch_stop_signals();
  launch::ProgressDisplay display;
  const auto tires = scenario::tires_of(spec);
  const ProgressCall pressing = launch::shown_on(display, " while tires were pressed");
  const auto standing = scenario::standing_tires(
      spec, tires, [&](const std::string& what, double share) { pressing(what + " the tires", share); });
  const double pressed = wall_clock();
  vehicle::VehiclePage page = vehicle::vehicle_page(spec, standing, [&](const std::string& what, double share) {
    if (launch::stop_signalled())
      throw Error(ExitCode::stopped, "stopped by a signal while the vehicle was made to stand");
    if (wall_clock() - pressed > kQuiet) display.show({.phase = what, .share = share});
  });
  display.clear();
  for (const auto& odd : {vehicle::stops_at_rest(spec, page.trim), vehicle::steers_against(spec, page)})
    for (const auto& [key, what] : odd) print_warning(input_error(spec.file, key, what).what());
  return page;
}

std::vector<vehicle::KinematicsRow> sweep(const vehicle::VehicleSpec& spec, const vehicle::VehiclePage& page,
                                          const vehicle::KinematicsOptions& options) {
  launch::ProgressDisplay display;
  const ProgressCall show = launch::shown_on(display, " while suspensions were moved");
  try {
    std::vector<vehicle::KinematicsRow> rows = vehicle::kinematics(spec, page.loaded_radii, options, show);
    if (rows.empty())
      throw input_error(spec.file, "axles", "has no wheel that travels, expected a suspension other than fixed");
    return rows;
  } catch (const Error& error) {
    if (error.code() != ExitCode::physics) throw;
    throw input_error("command line", "--travel", "is {:.4g} m: {}, expected a travel that every axle of {} can follow",
                      options.travel, error.what(), spec.file);
  }
}

nlohmann::ordered_json summary(const vehicle::VehicleSpec& spec, const vehicle::VehiclePage& page,
                               const vehicle::KinematicsOptions& options) {
  nlohmann::ordered_json json = {
      {"format_version", kVehicleVersion}, {"version", FURROW_VERSION}, {"vehicle", spec.name}, {"file", spec.file},
      {"travel_m", options.travel},        {"points", options.points}};
  vehicle::KinematicsOptions drawn = options;
  drawn.points = 1;
  json["as_drawn"] = nlohmann::ordered_json::array();
  for (const vehicle::KinematicsRow& row : sweep(spec, page, drawn))
    if (row.motion == "parallel") json["as_drawn"].push_back(figures_json(row));
  json["at_rest"] = vehicle::page_json(page);
  return json;
}

ExitCode kinematics(const KinematicsArguments& arguments) {
  check(arguments);
  const std::filesystem::path file = scenario::find_vehicle_alone(arguments.vehicle);
  const vehicle::VehicleSpec spec = vehicle::read_vehicle(file);
  const vehicle::VehiclePage page = stand(spec);
  vehicle::KinematicsOptions options{arguments.travel, arguments.points};
  if (options.travel == 0.0)
    options.travel = kTravelShare * *std::min_element(page.loaded_radii.begin(), page.loaded_radii.end());
  const std::vector<vehicle::KinematicsRow> rows = sweep(spec, page, options);
  if (arguments.csv) {
    std::cout << vehicle::kinematics_csv(rows);
    return ExitCode::done;
  }
  nlohmann::ordered_json json = summary(spec, page, options);
  if (arguments.json) {
    json["rows"] = nlohmann::ordered_json::array();
    for (const vehicle::KinematicsRow& row : rows) json["rows"].push_back(figures_json(row));
    std::cout << json.dump(2) << "\n";
    return ExitCode::done;
  }
  launch::RunDirectory directory(file.stem().string() + "-kc", arguments.out, arguments.overwrite);
  try {
    directory.add({"kinematics.csv", "summary.json"});
    write_whole_file(directory.path() / "kinematics.csv", vehicle::kinematics_csv(rows));
    write_whole_file(directory.path() / "summary.json", json.dump(2) + "\n");
  } catch (...) {
    directory.discard();
    throw;
  }
  std::cout << directory.path().string() << std::endl;
  if (arguments.plots) make_report_or_warn(directory.path());
  return ExitCode::done;
}

Action add_vehicle_options(CLI::App& command, Typed&) {
  const auto arguments = std::make_shared<KinematicsArguments>();
  command.add_option("VEHICLE", arguments->vehicle, "Read this vehicle file (JSON), as given or in vehicle/data/.")
      ->required();
  CLI::Option* out = add_folder_options(command, arguments->out, arguments->overwrite, "<vehicle>-kc-NNN");
  command.add_option("--travel", arguments->travel,
                     "Move the wheels up and down by this travel, m (default: a fifth of the smallest tire's radius).");
  command.add_option("--points", arguments->points, "Compute this number of points of each motion.")
      ->capture_default_str();
  add_no_plots(command, arguments->plots);
  CLI::Option* csv =
      command.add_flag("--csv", arguments->csv, "Print the table as CSV and make no folder.")->excludes(out);
  command.add_flag("--json", arguments->json, "Print table and figures as JSON and make no folder.")
      ->excludes(out)
      ->excludes(csv);
  return [arguments] { return kinematics(*arguments); };
}

}  // namespace

ExitCode validate_vehicle(const std::string& name, bool json) {
  const vehicle::VehicleSpec spec = vehicle::read_vehicle(scenario::find_vehicle(name));
  const vehicle::VehiclePage page = stand(spec);
  if (json)
    std::cout << vehicle::page_json(page).dump(2) << "\n";
  else
    print_text(vehicle::page_text(page), Piped::whole_lines);
  return ExitCode::done;
}

Command kinematics_entry() {
  return {.name = "kc",
          .task = task::test,
          .purpose =
              "Move the suspensions of a vehicle, tabulate camber, toe, roll centre, rates and more against travel and "
              "steering, and print the folder of the results.",
          .options = add_vehicle_options,
          .examples = {{"kc hmmwv.json --travel 0.05", "Move the wheels by 50 mm up and down."}}};
}

}  // namespace furrow::commands
