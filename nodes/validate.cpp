#include "nodes/validate.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "nodes/rank_table.hpp"
#include "nodes/scenario_checks.hpp"
#include "tire/ring_mesh.hpp"
#include "tire/tire_file.hpp"

namespace furrow {
namespace {

constexpr double kBytesPerRank = 40e6;        // program, MPI and libraries
constexpr double kBytesPerCoordinate = 20e3;  // shell matrices, tangent and its factors
constexpr double kBytesPerFrameGrain = 20.0;  // position, speed, radius in single precision
constexpr double kBytesPerFrameVertex = 100.0;
constexpr double kBytesPerSavedGrain = 300.0;  // in a checkpoint: state, pair list, contact history
constexpr double kBytesPerSavedCoordinate =
    110.0;                               // coordinates, velocities, and those that factors were made from
constexpr double kBytesPerLine = 900.0;  // of timeseries.csv, and the same again in results.h5
constexpr double kMegabyte = 1e6;

std::string pressure_text(const PressureSchedule& p) {
  if (!p.varies()) return fmt::format("{:g} kPa", 1e-3 * p.at(0.0));
  return fmt::format("{:g} kPa, later {:g} to {:g} kPa", 1e-3 * p.at(0.0), 1e-3 * p.lowest(),
                     1e-3 * p.highest());
}

double frames(const Scenario& s) {
  return s.output.frame_interval > 0.0 ? 1.0 + std::floor(s.run.end / s.output.frame_interval) : 0.0;
}

/// Of the undeformed tire about its centre.
MassProperties tire_mass(const TireOptions& options) {
  const TireFile file = tire_file_of(options);
  const RingMesh ring = make_ring_mesh(file);
  return rigid_mass(ring, element_masses(file, ring));
}

}  // namespace

Estimate estimate(const Scenario& s) {
  Estimate e;
  e.terrain = estimate_terrain(s.terrain);
  e.steps = s.run.steps();
  double vertices = 0.0;
  for (const TireOptions& options : s.tires) {
    const TireSize size = tire_size(options);
    e.coordinates += size.coordinates();
    vertices += size.vertices();
  }
  const auto ranks = static_cast<double>(rank_table(s).size());
  e.memory = e.terrain.memory_bytes + kBytesPerCoordinate * static_cast<double>(e.coordinates) +
             kBytesPerRank * ranks;
  e.disk = frames(s) * (kBytesPerFrameGrain * static_cast<double>(e.terrain.grains) +
                        kBytesPerFrameVertex * vertices) +
           kBytesPerLine * s.run.end / s.output.series_interval +
           s.checkpoint.keep * (kBytesPerSavedGrain * static_cast<double>(e.terrain.grains) +
                                kBytesPerSavedCoordinate * static_cast<double>(e.coordinates));
  return e;
}

MachineState machine_state() {
  MachineState state;
  std::ifstream info("/proc/meminfo");
  double kib = 0.0;
  for (std::string name, unit; info >> name >> kib; std::getline(info, unit))
    if (name == "MemAvailable:") state.memory_free = 1024.0 * kib;
  std::error_code error;
  const auto space = std::filesystem::space(std::filesystem::current_path(error), error);
  if (!error) state.disk_free = static_cast<double>(space.available);
  return state;
}

nlohmann::ordered_json validation_report(const Scenario& s) {
  const Estimate e = estimate(s);
  const bool grains = s.terrain.engine == "dem";
  nlohmann::ordered_json json;
  json["scenario"] = s.name;
  json["scenario_digest"] = s.digest;
  json["step_s"] = s.run.step;
  json["terrain_step_s"] = s.terrain.step;
  json["stable_step_s"] =
      grains ? nlohmann::ordered_json(e.terrain.stable_step) : nlohmann::ordered_json(nullptr);
  json["stable_step_limited_by"] = e.terrain.stable_reason;
  json["steps"] = e.steps;
  json["grains"] = e.terrain.grains;
  json["bed_height_m"] = e.terrain.expected_height;
  json["tire_coordinates"] = e.coordinates;
  json["memory_MB"] = std::round(e.memory / kMegabyte);
  json["disk_MB"] = std::round(e.disk / kMegabyte);
  for (std::size_t k = 0; k < s.tires.size(); ++k) {
    const AxlePath path = axle_path(s, k, tire_size(s.tires[k]).radius);
    json["axle_path_m"].push_back({path.from, path.to});
    json["tire_mass_kg"].push_back(tire_mass(s.tires[k]).mass);
  }
  for (const RankEntry& rank : rank_table(s))
    json["ranks"].push_back({{"rank", rank.rank}, {"node", rank.node}, {"does", rank.does}});
  json["warnings"] = s.warnings;
  return json;
}

std::string validation_text(const Scenario& s) {
  const Estimate e = estimate(s);
  const bool grains = s.terrain.engine == "dem";
  std::string text;
  const auto line = [&](const std::string& name, const std::string& value) {
    text += fmt::format("{:<12} {}\n", name, value);
  };
  line("scenario", fmt::format("{} (digest {})", s.file.string(), s.digest));
  line("run", fmt::format("{:g} s in {} steps of {:g} s, averaged from {:g} s on", s.run.end, e.steps,
                          s.run.step, s.run.average_from));
  if (grains)
    line("terrain step", fmt::format("{:g} s, {:.0f} % of the stable {:.3g} s ({})", s.terrain.step,
                                     100.0 * s.terrain.step / e.terrain.stable_step, e.terrain.stable_step,
                                     e.terrain.stable_reason));
  line("terrain",
       grains ? fmt::format("about {} grains of {:g} mm, law {}, bed about {:.0f} mm deep, bin {:g} × {:g} m",
                            e.terrain.grains, 1e3 * s.terrain.radius, s.terrain.law,
                            1e3 * e.terrain.expected_height, s.terrain.length, s.terrain.width)
              : std::string("rigid plane z = 0"));
  for (std::size_t k = 0; k < s.tires.size(); ++k) {
    const TireOptions& options = s.tires[k];
    const TireSize size = tire_size(options);
    const AxlePath path = axle_path(s, k, size.radius);
    line("tire",
         size.rigid
             ? fmt::format("{}, rigid, radius {:g} m", options.file.filename().string(), size.radius)
             : fmt::format("{}, {} × {} elements, {} coordinates, {}, radius {:g} m",
                           options.file.filename().string(), size.elements_circumference, size.elements_width,
                           size.coordinates(), pressure_text(size.pressure), size.radius));
    const MassProperties mass = tire_mass(options);
    line("tire mass", fmt::format("{:.2f} kg, spin inertia {:.3g} kg m²", mass.mass, mass.inertia(1, 1)));
    line("axle", fmt::format("from x = {:.3f} m to {:.3f} m", path.from, path.to));
  }
  line("memory", fmt::format("about {:.0f} MB in all", e.memory / kMegabyte));
  line("disk", fmt::format("about {:.0f} MB of results", e.disk / kMegabyte));
  return text + "ranks\n" + rank_table_text(s);
}

}  // namespace furrow
