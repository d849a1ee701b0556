#include "terrain/soil/soil_estimate.hpp"

#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "protocol/core/error.hpp"
#include "protocol/files/json_text.hpp"
#include "protocol/files/text_file.hpp"
#include "terrain/soil/bekker_wong.hpp"
#include "terrain/terrains.hpp"

namespace furrow::terrain::soil {
namespace {

using nlohmann::json;

constexpr int kFormatVersion = 1;
constexpr double kDegree = std::numbers::pi / 180.0;  // rad

json read_object(const std::filesystem::path& file, const std::string& expected) {
  json object = parse_json(read_text_file(file, expected), file.string());
  if (!object.is_object()) throw input_error(file.string(), "", "is no object, expected " + expected);
  const json version = object.value("format_version", json(nullptr));
  if (version.is_number() && version.get<double>() > kFormatVersion)
    throw input_error(file.string(), "format_version",
                      fmt::format("is {}: the file is newer than this program, expected at most {}",
                                  value_text(version), kFormatVersion));
  return object;
}

double number(const json& object, const std::filesystem::path& file, const std::string& key, double above) {
  if (!object.contains(key))
    throw input_error(file.string(), key,
                      "is missing: not the expected file, or not all soil tests were run");
  const json value = object.value(key, json(nullptr));
  if (!value.is_number() || !(value.get<double>() > above))
    throw input_error(file.string(), key,
                      fmt::format("is {}, expected a number{}", value_text(value),
                                  std::isfinite(above) ? " above " + number_text(above) : ""));
  return value.get<double>();
}

SoilStrength strength_of(const json& soil, const std::filesystem::path& file, double width) {
  SoilStrength s;
  s.k_c = number(soil, file, "k_c", -INFINITY);
  s.k_phi = number(soil, file, "k_phi", -INFINITY);
  s.n = number(soil, file, "n", 0.0);
  s.cohesion = number(soil, file, "cohesion_Pa", -INFINITY);
  s.phi = kDegree * number(soil, file, "friction_angle_deg", -INFINITY);
  s.K = number(soil, file, "janosi_K_m", 0.0);
  if (!(s.k_c / width + s.k_phi > 0.0))
    throw input_error(file.string(), "k_phi",
                      fmt::format("k_c/b + k_phi is {:g} for a wheel {:g} m wide, expected a number above 0",
                                  s.k_c / width + s.k_phi, width));
  return s;
}

/// Error of the pull from the parameters' standard errors, as if they were independent, N.
double pull_error(const json& soil, const SoilStrength& s, const RigidWheel& wheel, double slip) {
  const json errors = soil.value("standard_error", json::object());
  const double pull = soil::rigid_wheel(s, wheel, slip).pull;
  double sum = 0.0;
  const auto vary = [&](const char* key, double SoilStrength::*member, double unit) {
    const json error = errors.value(key, json(nullptr));
    if (!error.is_number()) return;
    SoilStrength other = s;
    other.*member += unit * error.get<double>();
    const auto estimate = soil::rigid_wheel(other, wheel, slip);
    if (estimate.found) sum += std::pow(estimate.pull - pull, 2);
  };
  vary("k_c", &SoilStrength::k_c, 1.0);
  vary("k_phi", &SoilStrength::k_phi, 1.0);
  vary("n", &SoilStrength::n, 1.0);
  vary("cohesion_Pa", &SoilStrength::cohesion, 1.0);
  vary("friction_angle_deg", &SoilStrength::phi, kDegree);
  vary("janosi_K_m", &SoilStrength::K, 1.0);
  return std::sqrt(sum);
}

void require_grains(const json& scenario, const std::filesystem::path& file) {
  const ReadContext context{file.string(), "terrain"};
  const json section = scenario.value("terrain", json::object());
  const json engine = section.is_object() ? section.value("engine", json()) : json();
  const std::string name = engine.is_string() ? engine.get<std::string>() : CommonOptions().engine;
  if (find_terrain(name, context).read(json::object(), context)->grains()) return;
  throw input_error(context.file, context.key("engine"),
                    "is '" + name + "', expected " + engines_with_grains() + ": theory needs a soil");
}

}  // namespace

std::string write_soil_estimate(const std::filesystem::path& run, const std::filesystem::path& soil_file) {
  const std::filesystem::path summary_file = run / "summary.json";
  json summary = read_object(summary_file, "the summary of a finished run");
  if (const json wheels = summary.value("wheels", json::array()); !wheels.empty())
    summary.update(wheels.front());  // the estimate is for wheel 0
  const std::filesystem::path scenario_file = run / "scenario.json";
  const json scenario = read_object(scenario_file, "the scenario of a finished run");
  require_grains(scenario, scenario_file);
  RigidWheel wheel;
  wheel.radius = number(summary, summary_file, "tire_radius_m", 0.0);
  wheel.width = number(summary, summary_file, "tread_width_m", 0.0);
  wheel.load = number(summary, summary_file, "vertical_load_N", 0.0);
  const double slip = number(summary, summary_file, "slip", -INFINITY);

  const std::filesystem::path file =
      std::filesystem::is_directory(soil_file) ? soil_file / "soil.json" : soil_file;
  const json soil = read_object(file, "the soil.json that 'furrow soil' writes");
  const SoilStrength s = strength_of(soil, file, wheel.width);
  const WheelEstimate e = soil::rigid_wheel(s, wheel, slip);

  nlohmann::ordered_json j;
  j["format_version"] = kFormatVersion;
  j["what"] = "rigid wheel by Bekker, Wong & Reece, Janosi & Hanamoto";
  j["soil_file"] = std::filesystem::absolute(file).lexically_normal().string();
  const bool quick = soil.value("quick", false);
  j["quick"] = quick;
  j["soil"] = {{"k_c", s.k_c},
               {"k_phi", s.k_phi},
               {"n", s.n},
               {"cohesion_Pa", s.cohesion},
               {"friction_angle_deg", s.phi / kDegree},
               {"janosi_K_m", s.K}};
  j["wheel"] = {{"radius_m", wheel.radius}, {"width_m", wheel.width}, {"load_N", wheel.load}};
  j["slip"] = slip;
  j["found"] = e.found;
  std::string text = "soil theory: this soil does not carry a rigid wheel of that load";
  if (e.found) {
    const double error = pull_error(soil, s, wheel, slip);
    j["drawbar_pull_N"] = e.pull;
    j["drawbar_pull_standard_error_N"] = error;
    j["sinkage_m"] = e.sinkage;
    j["thrust_N"] = e.thrust;
    j["compaction_resistance_N"] = e.resistance;
    j["drive_torque_Nm"] = e.torque;
    j["largest_pressure_Pa"] = e.pressure;
    text = fmt::format("soil theory (rigid wheel): drawbar pull {:.0f} ± {:.0f} N, sinkage {:.1f} mm", e.pull,
                       error, 1e3 * e.sinkage);
    if (quick) text += "; from a quick look at the soil, no result to quote";
    const json sinkage = summary.value("sinkage_m", json()),
               clearance = summary.value("bed_clearance_m", json());
    if (sinkage.is_number() && clearance.is_number())
      if (const double depth = sinkage.get<double>() + clearance.get<double>(); e.sinkage > depth)
        text +=
            fmt::format("; deeper than the bed of {:.0f} mm, of which the theory knows nothing", 1e3 * depth);
  }
  for (int k = 0; k <= 16; ++k) {
    const WheelEstimate at = soil::rigid_wheel(s, wheel, 0.05 * k);
    if (at.found)
      j["curve"].push_back({{"slip", 0.05 * k}, {"drawbar_pull_N", at.pull}, {"sinkage_m", at.sinkage}});
  }
  write_whole_file(run / "soil_estimate.json", j.dump(2) + "\n");
  return text;
}

}  // namespace furrow::terrain::soil
