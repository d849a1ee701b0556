#include "nodes/scenario/starter.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <initializer_list>
#include <optional>
#include <system_error>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "nodes/scenario/load_scenario.hpp"
#include "nodes/scenario/schema.hpp"
#include "nodes/scenario/soil_material.hpp"
#include "nodes/scenario/vehicle_tires.hpp"
#include "nodes/scenario/wheel_geometry.hpp"
#include "nodes/scenario/wheel_scales.hpp"
#include "protocol/core/constants.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/data_files.hpp"
#include "protocol/files/json_text.hpp"
#include "protocol/files/text_file.hpp"
#include "terrain/dem/dem_options.hpp"
#include "terrain/terrains.hpp"
#include "vehicle/driver/driver_car.hpp"
#include "vehicle/spec/read_vehicle.hpp"

namespace furrow::scenario {
namespace {

using Json = nlohmann::ordered_json;

// The small rig, the model for the lengths and times of all others.
constexpr double kRadius = 0.4673, kLoad = 4608.0;                        // m, N
constexpr double kCohesion = 80e3, kModulus = 2.49e7, kPressure = 155e3;  // Pa
// In tire radii.
constexpr double kGrain = 1.0 / 45.0, kAhead = 2.2, kBehind = 1.2, kBeside = 0.4;
constexpr double kAcross = 11.0,
                 kAlong = 14.0;                 // grain radii in a tread's width, at least, and in a contact's length
constexpr double kCoarser = 0.7, kFiner = 2.0;  // of the radius with which a soil was measured: between, that is taken
constexpr int kLayers = 14, kMostLayers = 120;
constexpr double kDepth = 8.5;                  // sinkages
constexpr double kTreadSpeed = 0.93;            // √(g R)
constexpr double kLowering = 0.18;              // √(g R)
constexpr double kSlip = 0.3, kHardSlip = 0.1;  // on soil, on hard ground
// In √(R/kRadius) s.
constexpr double kMoveFrom = 0.4, kRamp = 0.15, kAverageFrom = 1.2, kEnd = 3.0;
constexpr double kVehicleEnd = 2.5, kThrottleFrom = 0.5, kThrottleAt = 0.7, kThrottle = 0.7;
constexpr double kStepShare = 0.8;     // of the stable step
constexpr double kTinyStep = 1e-7;     // s, that any terrain takes
constexpr double kLargestStep = 5e-4;  // s, where neither grains nor tire ask for a smaller one
constexpr double kNodes = 20.0;        // of empirical soil across a tread
constexpr std::size_t kColumns = 110;  // of a comment

/// The number as a person would type it.
double typed(double value) { return std::strtod(fmt::format("{:.10g}", value).c_str(), nullptr); }

/// Rounds to two significant digits.
double rounded(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
  return typed(std::round(value / unit) * unit);
}

enum class Ground { grains, empirical, hard };

struct Scales {
  Ground ground = Ground::grains;
  double radius = 0.0, tread = 0.0;  // of the smallest tire, m
  double largest = 0.0;              // radius, m
  double first = 0.0, last = 0.0;    // axles, x, m
  double across = 0.0;               // of the outermost point of any wheel, |y|, m
  bool meshed = false;               // the tire is a shell with a mesh that the scenario may set
  double measured_with = 0.0;        // grain radius for which the soil's strength is known, m
  // On the soil; first guesses until a bed was described.
  double pressure = kPressure;  // under the wheel that presses most, Pa
  double sinkage = 0.0;         // of the wheel with the largest sinkage, m
  double contact = 0.0;         // the shortest contact, m
  double layer = 1.3;           // height of a layer, grain radii
  double lowered = 0.0;         // time at which the load is carried, s
  double near_wall = 0.0;       // distance within which the end wall has an effect, m
};

Scales scales_of(const Scenario& s) {
  Scales scales;
  const std::vector<tire::TireDescription> tires = describe_tires(s);
  const rigs::RigDescription rig = describe_rig(s, tires);
  scales.radius = scales.tread = 1e300;
  scales.first = -1e300, scales.last = 1e300;
  for (std::size_t k = 0; k < tires.size(); ++k) {
    const tire::TireDescription& tire = tires[k];
    const rigs::WheelDescription& wheel = rig.wheels[k];
    scales.radius = std::min(scales.radius, tire.radius);
    scales.largest = std::max(scales.largest, tire.radius);
    scales.tread = std::min(scales.tread, tire.tread_width);
    scales.first = std::max(scales.first, wheel.from);
    scales.last = std::min(scales.last, wheel.from);
    scales.across = std::max(scales.across, std::abs(wheel.lateral) + wheel.across);
    scales.meshed = std::find(tire.takes.begin(), tire.takes.end(), "elements_width") != tire.takes.end();
  }
  return scales;
}

/// A tire whose file holds for hard ground gets that; a soil file without properties of grains is empirical soil.
Ground ground_of(const StarterOptions& o, const nlohmann::json& soil, const Scenario& s) {
  const bool hard = s.has_own_contact();
  if (hard && !o.soil.empty())
    throw input_error("command line", "--soil",
                      "is given, expected none: the file of '{}' holds for hard ground; with --rigid the tires "
                      "keep their shape and roll on soil",
                      s.tires.front()->options().file.filename().string());
  if (hard) return Ground::hard;
  if (o.soil.empty()) return Ground::grains;
  for (const auto& [key, value] : soil.items())
    if (std::ranges::count(terrain::engines_of_key(key), terrain::CommonOptions().engine) > 0) return Ground::grains;
  return Ground::empirical;
}

void add_soil(Scales& scales, const Scenario& s) {
  if (const terrain::dem::DemOptions* grains = s.terrain->grains()) {
    scales.layer = s.terrain->estimate(s.terrain_context()).expected_height / (grains->layers * grains->radius);
    scales.pressure = 0.0, scales.contact = 1e300;
  }
  const std::vector<rigs::WheelDescription> wheels = describe_rig(s).wheels;
  const std::vector<WheelScales> all = wheel_scales(s);
  for (std::size_t k = 0; k < all.size(); ++k) {
    scales.lowered = std::max(scales.lowered, all[k].lowering_needs);
    if (!all[k].grains) continue;
    scales.pressure = std::max(scales.pressure, all[k].grains->pressure);
    scales.contact = std::min(scales.contact, all[k].grains->contact_length);
    scales.sinkage = std::max(scales.sinkage, all[k].grains->reach);
    scales.near_wall = std::max(scales.near_wall,
                                all[k].grains->near_end * std::abs(wheels[k].speed) * (s.run.end - s.run.average_from));
  }
}

double tread_speed(const Scales& s) { return kTreadSpeed * std::sqrt(kStandardGravity * s.radius); }
double time_scale(const Scales& s) { return std::sqrt(s.radius / kRadius); }
double slip_of(const Scales& s) { return s.ground == Ground::hard ? kHardSlip : kSlip; }
/// Time at which a drawbar rig begins to move, s.
double begin(const Scales& s) { return std::max(kMoveFrom * time_scale(s), 1.1 * s.lowered); }

Json rig_section(const StarterOptions& o, const Scales& s) {
  Json rig;
  const double time = time_scale(s);
  if (!o.vehicle.empty()) {
    rig["type"] = "vehicle";
    rig["vehicle"] = o.vehicle;
    // Another kind of file is reported after the scenario was read.
    const auto car =
        is_vehicle(o.vehicle) ? std::optional(vehicle::read_vehicle(find_vehicle(o.vehicle))) : std::nullopt;
    if (!car || vehicle::can_drive(*car))
      rig["driver"]["inputs"]["throttle"] = {
          {0, 0}, {rounded(kThrottleFrom * time), 0}, {rounded(kThrottleAt * time), kThrottle}};
    if (!car || vehicle::can_brake(*car))
      rig["driver"]["inputs"]["brake"] = {
          {0, 1}, {rounded(kThrottleFrom * time), 1}, {rounded(1.1 * kThrottleFrom * time), 0}};
    return rig;
  }
  rig["type"] = "drawbar";
  rig["mode"] = "fixed_angular_speed";
  rig["angular_speed"] = rounded(tread_speed(s) / s.radius);
  rig["slip"] = slip_of(s);
  rig["load"] = o.load > 0.0 ? o.load : rounded(kLoad * std::pow(s.radius / kRadius, 3));
  rig["lowering_speed"] = rounded(kLowering * std::sqrt(kStandardGravity * s.radius));
  rig["move_from"] = rounded(begin(s));
  rig["ramp"] = rounded(kRamp * time);
  return rig;
}

/// The tire's own mesh is for results; this coarser one gives a first result within minutes.
Json tire_section(const StarterOptions& o, const Scales& s) {
  Json tire;
  if (!o.tire.empty() || o.vehicle.empty()) tire["file"] = o.tire.empty() ? "hmmwv_layered.json" : o.tire;
  if (o.rigid) {
    tire["rigid"] = true;
  } else if (s.meshed) {
    tire["elements_circumference"] = o.vehicle.empty() ? 60 : 40;
    tire["elements_width"] = o.vehicle.empty() ? 12 : 8;
  }
  return tire;
}

/// `soil`: the values of its file; the scenario has its own where that gives none.
Json terrain_section(const StarterOptions& o, const nlohmann::json& soil, const Scales& s, double travel) {
  Json terrain;
  const double length = rounded(1.02 * (travel + s.first - s.last + (kAhead + kBehind) * s.largest + s.near_wall));
  const double width = rounded(1.02 * 2.0 * (s.across + std::max(kBeside * s.radius, 0.55 * s.tread)));
  if (s.ground == Ground::hard) return Json::object({{"engine", "rigid"}});
  if (s.ground == Ground::empirical)
    return Json::object({{"engine", "scm"},
                         {"material", o.soil},
                         {"length", length},
                         {"width", width},
                         {"grid_spacing", rounded(s.tread / kNodes)}});
  terrain["engine"] = terrain::CommonOptions().engine;
  if (o.soil.empty()) {
    terrain["friction"] = 0.9;
    terrain["cohesion"] = rounded(kCohesion * s.radius / kRadius);
  } else {
    terrain["material"] = o.soil;
  }
  // The contact of a vehicle's wheel has the same size, but the bed is many times as long and wide.
  const double coarse = o.vehicle.empty() ? 1.0 : 2.0;
  const double wanted = std::min(std::max(coarse * kGrain * s.radius, s.contact / kAlong), s.tread / kAcross);
  // Grains of another size are better than a strength that nobody has measured, up to what they cost.
  terrain["radius"] =
      wanted > kCoarser * s.measured_with && wanted < kFiner * s.measured_with ? s.measured_with : rounded(wanted);
  // Scales with the pressure of the small rig: stiffer grains need shorter steps, softer ones overlap more.
  if (!soil.contains("young_modulus"))
    terrain["young_modulus"] = rounded(kModulus * std::min(1.0, s.pressure / kPressure));
  terrain["layers"] =
      std::clamp(static_cast<int>(std::ceil(kDepth * s.sinkage / (s.layer * terrain["radius"].get<double>()))), kLayers,
                 kMostLayers);
  terrain["length"] = length;
  terrain["width"] = width;
  return terrain;
}

Json run_section(const StarterOptions& o, const Scales& s) {
  const double time = time_scale(s);
  Json run;
  run["step"] = kTinyStep;
  const double late = o.vehicle.empty() ? begin(s) - kMoveFrom * time : 0.0;
  run["end"] = rounded((o.vehicle.empty() ? kEnd : kVehicleEnd) * time + late);
  run["average_from"] = rounded((o.vehicle.empty() ? kAverageFrom : 0.6 * kVehicleEnd) * time + late);
  run["seed"] = 1;
  return run;
}

Json output_section(const Scales& s) {
  Json output;
  output["series_interval"] = rounded(2e-3 * time_scale(s));
  output["frame_interval"] = rounded(0.04 * time_scale(s));
  return output;
}

std::string comment(const std::string& text, const std::string& indent) {
  std::string lines, line;
  std::size_t from = 0;
  while (from < text.size()) {
    const std::size_t to = std::min(text.find(' ', from), text.size());
    const std::string word = text.substr(from, to - from);
    if (!line.empty() && indent.size() + line.size() + word.size() > kColumns) {
      lines += indent + "// " + line + "\n";
      line.clear();
    }
    line += (line.empty() ? "" : " ") + word;
    from = to + 1;
  }
  return lines + indent + "// " + line + "\n";
}

/// A section with the schema's descriptions of its keys.
std::string section_text(const Schema& schema, const std::string& name, const Json& section) {
  std::string text = fmt::format("  \"{}\": {{\n", name);
  std::size_t left = section.size();
  for (const auto& [key, value] : section.items()) {
    if (const nlohmann::json* node = schema.find(name + "." + key)) {
      const std::string unit = node->value("unit", "");
      text += comment(node->value("description", "") + (unit.empty() ? "" : " [" + unit + "]"), "    ");
    }
    text += fmt::format("    \"{}\": {}{}\n", key, value.is_number() ? number_text(value.get<double>()) : value.dump(),
                        --left > 0 ? "," : "");
  }
  return text + "  }";
}

std::string text_of(const Json& document, const std::string& file) {
  const Schema& schema = Schema::of_scenarios();
  std::string text = comment(
      "A scenario of Furrow. All values are in SI units, angles in radians. 'furrow explain' lists all keys, those "
      "with their defaults that do not stand here too.",
      "");
  text += comment("Check it: furrow validate " + file, "") + comment("Run it:   furrow run " + file, "") + "{\n";
  std::size_t left = document.size();
  for (const auto& [key, value] : document.items()) {
    text += value.is_object() ? section_text(schema, key, value) : fmt::format("  \"{}\": {}", key, value.dump());
    text += --left > 0 ? ",\n" : "\n";
  }
  return text + "}\n";
}

/// Reads the document as the program would for a run.
Scenario checked(const std::filesystem::path& file, const Json& document) {
  write_whole_file(file, text_of(document, file.string()));
  return load_scenario(file, {});
}

/// Rounds to 1, 2, 4, 5 or 8 times a power of ten, so that usual times are whole numbers of steps.
double step_of(const Scenario& s) {
  const double stable = kStepShare * s.terrain->estimate(s.terrain_context()).stable_step;
  const double largest = std::min({stable, kLargestStep, smallest_coupling_step(s).step});
  const double unit = std::pow(10.0, std::floor(std::log10(largest)));
  double step = unit;
  for (const double digit : {2.0, 4.0, 5.0, 8.0})
    if (digit * unit <= largest) step = digit * unit;
  return typed(step);
}

/// Rounds the times of a section to whole numbers of `step`.
void fit(Json& section, std::initializer_list<const char*> keys, double step) {
  for (const char* key : keys)
    section[key] = typed(std::max(1.0, std::round(section[key].get<double>() / step)) * step);
}

void write(const std::filesystem::path& file, const StarterOptions& o) {
  Json document;
  document["format_version"] = 1;
  document["description"] = "";
  Scales scales;
  scales.radius = kRadius;
  document["rig"] = rig_section(o, scales);
  if (const Json tire = tire_section(o, scales); !tire.empty()) document["tire"] = tire;
  document["terrain"]["engine"] = "rigid";
  const Scenario first = checked(file, document);
  SoilFile soil;
  if (!o.soil.empty()) soil = read_soil_file(find_file(o.soil, "terrain.material", file));
  const Ground ground = ground_of(o, soil.values, first);
  scales = scales_of(first);
  document["description"] = std::string(o.vehicle.empty() ? "A wheel on " : "A vehicle on ") +
                            (ground == Ground::hard ? "hard ground." : "soil.");

  if (const Json tire = tire_section(o, scales); !tire.empty()) document["tire"] = tire;
  scales = scales_of(checked(file, document));  // the mesh decides the width of the tread
  scales.ground = ground;
  scales.measured_with = measured_radius(soil).value_or(0.0);
  const double travel = o.vehicle.empty()
                            ? (1.0 - slip_of(scales)) * tread_speed(scales) * (kEnd - kMoveFrom) * time_scale(scales)
                            : 8.0 * scales.radius;
  for (int pass = 0; pass < 2; ++pass) {  // the sinkage on the first bed decides the depth of the second
    document["rig"] = rig_section(o, scales);
    document["terrain"] = terrain_section(o, soil.values, scales, travel);
    document["run"] = run_section(o, scales);
    if (pass == 0) add_soil(scales, checked(file, document));
  }
  document["output"] = output_section(scales);
  const double step = step_of(checked(file, document));
  document["run"]["step"] = step;
  fit(document["output"], {"series_interval", "frame_interval"}, step);
  fit(document["run"], {"end", "average_from"}, step);
  checked(file, document);
}

}  // namespace

void write_starter(const std::filesystem::path& file, const StarterOptions& options) {
  std::error_code error;
  if (std::filesystem::exists(std::filesystem::symlink_status(file, error)))
    throw input_error("command line", "NAME", "'{}' exists already, expected a new file", file.string());
  for (const std::string& other : {options.tire, options.soil, options.vehicle})
    if (std::filesystem::path(other) == file.filename())
      throw input_error("command line", "NAME",
                        "is '{}': beside that scenario the name would no longer lead to the file that it is to use, "
                        "expected another one",
                        file.string());
  try {
    write(file, options);
  } catch (...) {
    std::filesystem::remove(file, error);
    throw;
  }
}

}  // namespace furrow::scenario
