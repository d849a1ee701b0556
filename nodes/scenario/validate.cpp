#include "nodes/scenario/validate.hpp"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "nodes/scenario/estimate.hpp"
#include "nodes/scenario/grain_loads.hpp"
#include "nodes/scenario/rank_table.hpp"
#include "nodes/scenario/wheel_geometry.hpp"
#include "nodes/scenario/wheel_scales.hpp"
#include "protocol/files/digits.hpp"
#include "protocol/files/json_number.hpp"

namespace furrow::scenario {
namespace {

constexpr double kMegabyte = 1e6;

const char* sinkage_by(const WheelScales::OnGrains& g) { return g.by_cone_index ? "cone index" : "bearing capacity"; }

nlohmann::ordered_json scales_json(const WheelScales& w, const std::string& name) {
  nlohmann::ordered_json json;
  if (!name.empty()) json["name"] = name;
  json["load_N"] = w.load;
  json["froude_number"] = json_number(w.froude);
  if (!w.grains) return json;
  const WheelScales::OnGrains& g = *w.grains;
  json["contact_pressure_Pa"] = json_number(g.pressure);
  json["contact_length_m"] = g.contact_length;
  json["width_in_grains"] = g.grains_wide;
  json["contact_length_in_grains"] = g.grains_long;
  json["expected_sinkage_m"] = g.sinkage;
  json["sinkage_by"] = sinkage_by(g);
  json["bed_height_over_sinkage"] = json_number(g.depth_ratio);
  json["beside_m"] = g.beside ? nlohmann::ordered_json(*g.beside) : nlohmann::ordered_json(nullptr);
  json["ahead_at_end_m"] = g.ahead;
  json["window_near_end_wall"] = g.near_end;
  json["inertial_number"] = json_number(g.inertial);
  return json;
}

/// Name and text of each line. @param travels whether the wheel's travel is known
std::vector<std::pair<std::string, std::string>> scales_lines(const WheelScales& w, bool travels) {
  std::vector<std::pair<std::string, std::string>> lines{{"load", digits(w.load) + " N"}};
  std::string speed = fmt::format("Froude number {}", digits(w.froude));
  if (w.grains) {
    const WheelScales::OnGrains& g = *w.grains;
    lines.emplace_back(
        "contact", fmt::format("about {} mm long at {} kPa, {} grains long, {} wide", digits(1e3 * g.contact_length),
                               digits(1e-3 * g.pressure), digits(g.grains_long), digits(g.grains_wide)));
    const std::string tips = g.reach > g.sinkage ? fmt::format(", {} with the grousers", digits(1e3 * g.reach)) : "";
    lines.emplace_back("sinkage", fmt::format("about {} mm by {}{}; the bed is {} times as deep as the wheel reaches",
                                              digits(1e3 * g.sinkage), sinkage_by(g), tips, digits(g.depth_ratio)));
    lines.emplace_back("walls", fmt::format("{}, {} m ahead of the wheel at the {}",
                                            g.beside ? digits(*g.beside) + " m beside the wheel" : "none beside",
                                            digits(g.ahead), travels ? "end" : "start"));
    speed += fmt::format(", inertial number {}", digits(g.inertial));
  }
  if (travels || w.froude > 0.0) lines.emplace_back("speed", speed);
  return lines;
}

nlohmann::ordered_json time_json(const RunTime& t) {
  return {{"all_s", json_number(t.all())},
          {"start_s", json_number(t.start)},
          {"bed_s", json_number(t.bed)},
          {"bed_is_kept", t.bed_is_kept},
          {"run_s", json_number(t.run)},
          {"writing_s", json_number(t.writing)},
          {"step_s", json_number(t.step)},
          {"slowest_tire_s", json_number(t.tire)},
          {"terrain_s", json_number(t.terrain)},
          {"awake_share", json_number(t.awake)},
          {"refined_share", json_number(t.refined)},
          {"terrain_ranks", t.ranks},
          {"terrain_threads", t.threads},
          {"ghosts_per_rank", std::round(t.ghosts)},
          {"cores", t.cores}};
}

std::vector<Bound> all_bounds(const Scenario& s) {
  std::vector<Bound> bounds = scale_bounds(s);
  if (const auto hard = too_hard(s, grain_loads(s))) bounds.push_back(*hard);
  return bounds;
}

/// " (front_left, rear_left)"; empty if the rig has one wheel.
std::string wheels_text(const Bound& bound, std::size_t all) {
  if (bound.wheels.empty()) return "";
  return bound.wheels.size() == all ? " (all wheels)" : fmt::format(" ({})", fmt::join(bound.wheels, ", "));
}

/// "about 2 min".
std::string duration(double seconds) {
  if (seconds < 100.0) return digits(seconds) + " s";
  if (seconds < 6000.0) return digits(seconds / 60.0) + " min";
  return digits(seconds / 3600.0) + " h";
}

std::string time_text(const RunTime& t) {
  std::string text =
      fmt::format("about {} on {} core{} that nobody else uses: ", duration(t.all()), t.cores, t.cores > 1 ? "s" : "");
  text += fmt::format("start of the ranks {}, ", duration(t.start));
  if (t.bed > 0.0) text += fmt::format("bed {}, ", duration(t.bed));
  if (t.writing >= 0.02 * t.all()) text += fmt::format("frames and checkpoints {}, ", duration(t.writing));
  text += fmt::format("run {}; of a step of {} ms the slowest tire takes {}, the terrain {}", duration(t.run),
                      digits(1e3 * t.step), digits(1e3 * t.tire), digits(1e3 * t.terrain));
  if (t.ranks > 1)
    text += fmt::format(" on each of {} ranks, {:.0f} copies of its neighbours' grains among them", t.ranks, t.ghosts);
  if (t.awake < 1.0) text += fmt::format(" with {:.0f} % of its grains awake", 100.0 * t.awake);
  if (t.refined >= 0.005)
    text += fmt::format(
        "; it takes its steps in parts for about {:.0f} % of the time, where contacts are too hard for them",
        100.0 * t.refined);
  return text;
}

}  // namespace

nlohmann::ordered_json validation_report(const Scenario& s, const RunTime* time) {
  const Estimate e = estimate(s);
  nlohmann::ordered_json json;
  json["scenario"] = s.name;
  json["scenario_digest"] = s.digest;
  json["step_s"] = s.run.step;
  json["exact_restart"] = s.terrain->describe().exact_restart;
  json["terrain_step_s"] = s.terrain_step();
  json["stable_step_s"] = json_number(e.terrain.stable_step);
  json["stable_step_limited_by"] = e.terrain.stable_reason;
  for (const CouplingStep& one : coupling_steps(s))
    json["coupling_step"].push_back({{"step_s", json_number(one.step)}, {"limited_by", one.because}});
  json["steps"] = e.steps;
  json["grains"] = e.terrain.grains;
  json["bed_height_m"] = e.terrain.expected_height;
  json["tire_coordinates"] = e.coordinates;
  json["memory_MB"] = std::round(e.memory / kMegabyte);
  json["disk_MB"] = std::round(e.disk / kMegabyte);
  json["terrain"] = {{"ranks", s.terrain_ranks},
                     {"memory_per_rank_bytes", e.terrain.memory_bytes / s.terrain_ranks},
                     {"checkpoint_bytes", e.terrain.checkpoint_bytes},
                     {"frame_bytes", e.terrain.frame_bytes}};
  if (time) json["time"] = time_json(*time);
  const std::vector<tire::TireDescription> tires = describe_tires(s);
  const rigs::RigDescription rig = describe_rig(s, tires);
  const std::vector<WheelScales> scales = wheel_scales(s);
  for (const rigs::WheelDescription& wheel : rig.wheels) json["axle_path_m"].push_back({wheel.from, wheel.to});
  for (const tire::TireDescription& tire : tires) json["tire_mass_kg"].push_back(tire.mass.mass);
  for (std::size_t k = 0; k < scales.size(); ++k) json["wheels"].push_back(scales_json(scales[k], rig.wheels[k].name));
  for (const RankEntry& rank : rank_table(s))
    json["ranks"].push_back({{"rank", rank.rank}, {"node", rank.node}, {"does", rank.does}});
  json["bound_by"] = nlohmann::ordered_json::array();
  for (const Bound& bound : all_bounds(s))
    json["bound_by"].push_back({{"key", bound.key}, {"what", bound.what}, {"wheels", bound.wheels}});
  json["warnings"] = s.warnings;
  return json;
}

std::string validation_text(const Scenario& s, const RunTime* time) {
  const Estimate e = estimate(s);
  std::string text;
  const auto line = [&](const std::string& name, const std::string& value) {
    text += fmt::format("{:<12} {}\n", name, value);
  };
  line("scenario", fmt::format("{} (digest {})", s.file.string(), s.digest));
  line("run", fmt::format("{:g} s in {} steps of {:g} s, averaged from {:g} s on", s.run.end, e.steps, s.run.step,
                          s.run.average_from));
  if (std::isfinite(e.terrain.stable_step))
    line("terrain step",
         fmt::format("{:g} s, {:.0f} % of the stable {:.3g} s ({})", s.terrain_step(),
                     100.0 * s.terrain_step() / e.terrain.stable_step, e.terrain.stable_step, e.terrain.stable_reason));
  if (const CouplingStep least = smallest_coupling_step(s); std::isfinite(least.step))
    line("run step", fmt::format("{:g} s, {:.0f} % of the {:.3g} s that {} allows", s.run.step,
                                 100.0 * s.run.step / least.step, least.step, least.because));
  line("terrain", e.terrain.text);
  if (const std::string device = s.terrain->device_text(s.terrain_context()); !device.empty()) line("GPU", device);
  const std::vector<tire::TireDescription> tires = describe_tires(s);
  const rigs::RigDescription rig = describe_rig(s, tires);
  const std::vector<WheelScales> scales = wheel_scales(s);
  for (std::size_t k = 0; k < tires.size(); ++k) {
    if (!rig.wheels[k].name.empty()) line("wheel", rig.wheels[k].name);
    line("tire", fmt::format("{}, {}, radius {:g} m", s.tires[k]->options().file.filename().string(), tires[k].details,
                             tires[k].radius));
    const MassProperties& mass = tires[k].mass;
    line("tire mass", fmt::format("{:.2f} kg, spin inertia {:.3g} kg m²", mass.mass, mass.inertia(1, 1)));
    // The distance of a vehicle that is driven by its pedals is not known yet.
    const double from = rig.wheels[k].from, to = rig.wheels[k].to;
    const bool travels = to != from;
    line("axle", travels ? fmt::format("from x = {:.3f} m to {:.3f} m", from, to)
                         : fmt::format("at x = {:.3f} m at the start", from));
    for (const auto& [name, value] : scales_lines(scales[k], travels)) line(name, value);
  }
  std::string memory = fmt::format("about {:.0f} MB in all", e.memory / kMegabyte);
  if (s.terrain_ranks > 1)
    memory += fmt::format(", {:.0f} MB of them for the grains of each rank of the terrain",
                          e.terrain.memory_bytes / s.terrain_ranks / kMegabyte);
  line("memory", memory);
  line("disk", fmt::format("about {:.0f} MB of results", e.disk / kMegabyte));
  if (time) line("time", time_text(*time));
  for (const Bound& bound : all_bounds(s))
    line("bound by", bound.key + wheels_text(bound, rig.wheels.size()) + ": " + bound.what);
  return text + "ranks\n" + rank_table_text(s);
}

}  // namespace furrow::scenario
