#include "nodes/scenario/vehicle_tires.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "protocol/core/assert.hpp"
#include "protocol/core/constants.hpp"
#include "protocol/files/data_files.hpp"
#include "protocol/files/json_text.hpp"
#include "tire/press/press.hpp"
#include "tire/press/press_curve.hpp"
#include "tire/tires.hpp"
#include "vehicle/spec/part_magnitudes.hpp"

namespace furrow::scenario {
namespace {

constexpr double kMore = 1.5;  // times the mean load of a wheel; tires are pressed up to this load

/// The file with this name, if there is one.
std::filesystem::path candidate(const std::string& name) {
  std::error_code error;
  for (const std::filesystem::path& place : {std::filesystem::path(name), data_folder() / "vehicle" / "data" / name})
    if (std::filesystem::exists(place, error)) return place;
  return name;
}

vehicle::StandingTire standing(const tire::TireSpec& tire, double load, const ProgressCall& progress) {
  const tire::TireDescription description = tire.describe();
  vehicle::StandingTire standing;
  const std::string file = tire.options().file.filename().string();
  standing.mass = description.mass;
  standing.radius = description.radius;
  standing.text = fmt::format("{}, {}, which does not deflect", file, description.name);
  if (const auto curve = tire::press_curve(tire, load, progress)) {
    standing.radius = curve->radius;
    standing.points = curve->points;
    standing.text = fmt::format("{}, pressed with {}", file, description.details);
  }
  return standing;
}

}  // namespace

std::filesystem::path find_vehicle(const std::string& name) {
  const std::filesystem::path file = named_file(name, {"vehicle/data"});
  std::error_code error;
  if (!std::filesystem::exists(file, error))
    throw input_error("command line", "VEHICLE", "'{}' does not exist, expected a file at that place or in {}", name,
                      (data_folder() / "vehicle" / "data").string());
  return file;
}

std::filesystem::path find_vehicle_alone(const std::string& name) {
  const std::filesystem::path file = find_vehicle(name);
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error) || is_vehicle(name)) return file;
  const nlohmann::ordered_json document = read_json_if_whole(file);
  if (!document.is_object() || (!document.contains("rig") && !document.contains("terrain"))) return file;
  const auto rig = document.find("rig");
  std::string what = "is a scenario, expected the file of a vehicle";
  if (rig != document.end() && rig->is_object() && rig->contains("vehicle") && (*rig)["vehicle"].is_string())
    what += fmt::format(": its rig.vehicle is '{}'", (*rig)["vehicle"].get<std::string>());
  throw input_error(file.string(), "", what);
}

bool is_vehicle(const std::string& name) {
  std::error_code error;
  const std::filesystem::path file = candidate(name);
  if (!std::filesystem::is_regular_file(file, error)) return false;
  const nlohmann::ordered_json document = read_json_if_whole(file);
  return document.is_object() && (document.contains("axles") || document.contains("chassis"));
}

std::vector<std::shared_ptr<const tire::TireSpec>> tires_of(const vehicle::VehicleSpec& spec) {
  std::vector<std::shared_ptr<const tire::TireSpec>> tires;
  for (std::size_t axle = 0; axle < spec.axles.size(); ++axle)
    for (const vehicle::CornerSpec& corner : spec.axles[axle].corners) {
      tire::TireOptions options;
      options.file = find_file(corner.wheel.tire, fmt::format("axles[{}].wheel.tire", axle), spec.file);
      options.rigid = corner.wheel.rigid;
      const auto same = std::find_if(tires.begin(), tires.end(), [&](const auto& tire) {
        return tire->options().file == options.file && tire->options().rigid == options.rigid;
      });
      if (same != tires.end()) {
        tires.push_back(*same);
        continue;
      }
      std::shared_ptr<const tire::TireSpec> tire = tire::read_tire(options);
      if (tire->static_test()) tire = tire::read_tire(tire::coarse_for_pressing(options));
      tires.push_back(std::move(tire));
    }
  return tires;
}

std::vector<vehicle::StandingTire> standing_tires(const vehicle::VehicleSpec& spec,
                                                  std::span<const std::shared_ptr<const tire::TireSpec>> tires,
                                                  const ProgressCall& progress) {
  FURROW_ASSERT(tires.size() == 2 * spec.axles.size(), tires.size(), spec.axles.size());
  double mass = vehicle::mass_without_tires(spec);
  std::vector<double> radii;
  for (const auto& tire : tires) {
    mass += tire->describe().mass.mass;
    radii.push_back(tire->describe().radius);
  }
  vehicle::check_height(spec, radii);
  const double load = kMore * mass * kStandardGravity / static_cast<double>(tires.size());
  for (const auto& tire : tires)
    vehicle::check_load(spec, mass, tire->options().file.filename().string(), tire::hopeless_load(tire->describe()));
  std::vector<vehicle::StandingTire> all;
  for (std::size_t k = 0; k < tires.size(); ++k) {
    const auto first = std::find(tires.begin(), tires.begin() + static_cast<long>(k), tires[k]) - tires.begin();
    if (first < static_cast<long>(k)) {
      all.push_back(all[static_cast<std::size_t>(first)]);
      continue;
    }
    try {
      all.push_back(standing(*tires[k], load, progress));
    } catch (const Error& error) {
      if (error.code() != ExitCode::physics) throw;
      throw input_error(spec.file, fmt::format("axles[{}].wheel.tire", k / 2), error.what());
    }
  }
  return all;
}

}  // namespace furrow::scenario
