#include "terrain/soil/soil_estimate.hpp"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "protocol/core/constants.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/digits.hpp"
#include "protocol/files/json_reader.hpp"
#include "protocol/files/json_text.hpp"
#include "protocol/files/text_file.hpp"
#include "terrain/soil/bekker_wong.hpp"
#include "terrain/terrains.hpp"

namespace furrow::terrain::soil {
namespace {

using nlohmann::json;

constexpr int kFormatVersion = 1;

/// A number that the theory needs, above zero or any.
double number(JsonReader& reader, const std::string& key, bool positive = false) {
  if (!reader.has(key)) reader.fail(key, "is missing: not the expected file, or not all soil tests were run");
  return positive ? reader.positive(key) : reader.number(key);
}

SoilStrength strength_of(JsonReader& soil, double width) {
  SoilStrength s;
  s.k_c = number(soil, "k_c");
  s.k_phi = number(soil, "k_phi");
  s.n = number(soil, "n", true);
  s.cohesion = number(soil, "cohesion_Pa");
  s.phi = kDegree * number(soil, "friction_angle_deg");
  s.K = number(soil, "janosi_K_m", true);
  if (!(s.k_c / width + s.k_phi > 0.0))
    soil.fail("k_phi", fmt::format("k_c/b + k_phi is {:g} for a wheel {:g} m wide, expected a number above 0",
                                   s.k_c / width + s.k_phi, width));
  return s;
}

/// Error of the pull from the parameters' standard errors, as if they were independent, N; NaN if none is known.
double pull_error(JsonReader& soil, const SoilStrength& s, const RigidWheel& wheel, double slip) {
  const json stated = soil.object_or_empty("standard_error");
  JsonReader errors(stated, soil.file(), soil.full("standard_error"));
  const double pull = soil::rigid_wheel(s, wheel, slip).pull;
  double sum = 0.0;
  bool known = false;
  const auto vary = [&](const char* key, double SoilStrength::*member, double unit) {
    if (!errors.given(key)) return;
    known = true;
    SoilStrength other = s;
    other.*member += unit * errors.not_negative(key);
    if (!std::isfinite(other.*member)) return void(sum = NAN);
    const auto estimate = soil::rigid_wheel(other, wheel, slip);
    if (estimate.found) sum += std::pow(estimate.pull - pull, 2);
  };
  vary("k_c", &SoilStrength::k_c, 1.0);
  vary("k_phi", &SoilStrength::k_phi, 1.0);
  vary("n", &SoilStrength::n, 1.0);
  vary("cohesion_Pa", &SoilStrength::cohesion, 1.0);
  vary("friction_angle_deg", &SoilStrength::phi, kDegree);
  vary("janosi_K_m", &SoilStrength::K, 1.0);
  return known ? std::sqrt(sum) : NAN;
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

/// The summary of a run with the values of wheel 0, to which the estimate applies.
json summary_of_wheel(const std::filesystem::path& file) {
  json summary = load_json(file, "the summary of a finished run");
  JsonReader reader(summary, file.string());
  if (!reader.has("wheels")) return summary;
  const json wheels = reader.array("wheels");
  if (wheels.empty()) return summary;
  summary.update(JsonReader(wheels.front(), file.string(), "wheels.0").object());
  return summary;
}

}  // namespace

std::string write_soil_estimate(const std::filesystem::path& run, const std::filesystem::path& soil_file) {
  const json summary = summary_of_wheel(run / "summary.json");
  JsonReader of_run(summary, (run / "summary.json").string());
  of_run.check_version(kFormatVersion);
  const std::filesystem::path scenario_file = run / "scenario.json";
  const json scenario = load_json(scenario_file, "the scenario of a finished run");
  require_grains(scenario, scenario_file);
  RigidWheel wheel;
  wheel.radius = number(of_run, "tire_radius_m", true);
  wheel.width = number(of_run, "tread_width_m", true);
  wheel.load = number(of_run, "vertical_load_N", true);
  const double slip = number(of_run, "slip");

  const std::filesystem::path file = std::filesystem::is_directory(soil_file) ? soil_file / "soil.json" : soil_file;
  const json soil = load_json(file, "the soil.json that 'furrow soil' writes");
  JsonReader of_soil(soil, file.string());
  of_soil.check_version(kFormatVersion);
  const SoilStrength s = strength_of(of_soil, wheel.width);
  const WheelEstimate e = soil::rigid_wheel(s, wheel, slip);

  nlohmann::ordered_json j;
  j["format_version"] = kFormatVersion;
  j["what"] = "rigid wheel by Bekker, Wong & Reece, Janosi & Hanamoto";
  j["soil_file"] = std::filesystem::absolute(file).lexically_normal().string();
  const bool quick = of_soil.flag_or("quick", false);
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
    const double error = pull_error(of_soil, s, wheel, slip);
    j["drawbar_pull_N"] = e.pull;
    j["drawbar_pull_standard_error_N"] = std::isfinite(error) ? json(error) : json(nullptr);
    j["sinkage_m"] = e.sinkage;
    j["thrust_N"] = e.thrust;
    j["compaction_resistance_N"] = e.resistance;
    j["drive_torque_Nm"] = e.torque;
    j["largest_pressure_Pa"] = e.pressure;
    text = fmt::format("soil theory (rigid wheel): drawbar pull {} N, sinkage {} mm",
                       std::isfinite(error) ? with_error(e.pull, error) : digits(e.pull), digits(1e3 * e.sinkage));
    if (quick) text += "; from a quick look at the soil, no result to quote";
    const json sinkage = summary.value("sinkage_m", json()), clearance = summary.value("bed_clearance_m", json());
    if (sinkage.is_number() && clearance.is_number())
      if (const double depth = sinkage.get<double>() + clearance.get<double>(); e.sinkage > depth)
        text += fmt::format("; deeper than the bed of {:.0f} mm, which the theory does not model", 1e3 * depth);
  }
  for (int k = 0; k <= 16; ++k) {
    const WheelEstimate at = soil::rigid_wheel(s, wheel, 0.05 * k);
    if (at.found) j["curve"].push_back({{"slip", 0.05 * k}, {"drawbar_pull_N", at.pull}, {"sinkage_m", at.sinkage}});
  }
  write_whole_file(run / "soil_estimate.json", j.dump(2) + "\n");
  return text;
}

}  // namespace furrow::terrain::soil
