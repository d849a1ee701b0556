#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "nodes/commands/bench.hpp"
#include "protocol/core/clock.hpp"
#include "protocol/core/error.hpp"
#include "protocol/core/hash.hpp"
#include "terrain/dem/beds/bed_csv.hpp"
#include "terrain/dem/beds/bed_generators.hpp"
#include "terrain/dem/beds/bed_settling.hpp"
#include "terrain/dem/dem_terrain.hpp"
#include "terrain/dem/solver_setup.hpp"

namespace furrow::commands {
namespace {

constexpr double kReferenceWidth = 0.6;  // m
constexpr double kLongest = 1000.0;      // m

/// Positions of the bed, and how long it is.
std::vector<terrain::dem::Quad> bed_of(const GrainBench& bench, terrain::TerrainOptions& options,
                                       const ProgressCall& progress) {
  std::vector<terrain::dem::Quad> grains;
  options.width = kReferenceWidth;
  if (bench.bed == "default") {
    const auto terrain = terrain::make_dem_terrain(options);
    terrain->prepare(progress);
    Archive archive;
    terrain->save(archive);
    const auto& x = archive.get<double>("terrain/position");
    for (std::size_t k = 0; k + 3 < x.size(); k += 4) grains.push_back({x[k], x[k + 1], x[k + 2], x[k + 3]});
    return grains;
  }
  grains = terrain::dem::read_positions_csv(bench.bed);
  double longest = 0.0;
  for (std::size_t k = 0; k < grains.size(); ++k) {
    terrain::dem::Quad& p = grains[k];
    if (!(p.x >= 0.0 && p.y >= 0.0 && p.y <= kReferenceWidth))
      throw input_error(bench.bed, fmt::format("line {}", k + 2),
                        fmt::format("the grain is outside the bin, expected x from 0 m on, y 0 to {:g} m",
                                    kReferenceWidth));
    if (p.x > kLongest)
      throw input_error(bench.bed, fmt::format("line {}", k + 2),
                        fmt::format("x is {:g} m, expected at most {:g} m", p.x, kLongest));
    longest = std::max(longest, p.x);
    p.y -= 0.5 * kReferenceWidth;
  }
  options.length = std::max(1.0, std::ceil(longest));
  options.periodic_x = true;
  terrain::dem::check_positions(options, bench.bed, grains);
  return grains;
}

void check(const GrainBench& bench) {
  const auto require = [](bool ok, const char* key, const char* expected) {
    if (!ok) throw input_error("command line", key, std::string("expected ") + expected);
  };
  require(bench.law == "mindlin" || bench.law == "coulomb", "--law", "mindlin or coulomb");
  require(bench.precision == "mixed" || bench.precision == "double", "--precision", "mixed or double");
  require(bench.threads >= 1 && bench.threads <= 1024, "--threads", "1 to 1024");
  require(bench.steps >= 1, "--steps", "1 or more");
  require(bench.warm >= 0, "--warm", "0 or more");
  require(bench.cohesion >= 0.0, "--cohesion", "0 or more, Pa");
  require(bench.rolling_friction >= 0.0, "--rolling-friction", "0 or more");
  require(bench.step > 0.0 && bench.step < 1.0, "--step", "above 0 and below 1 s");
  require(bench.save.empty() || bench.save != bench.bed, "--save-bed", "another file than --bed");
  require(bench.settle >= 0.0, "--settle", "0 or more, s");
}

}  // namespace

std::string bench_grains(const GrainBench& bench, const ProgressCall& progress) {
  check(bench);
  terrain::TerrainOptions options;
  options.law = bench.law;
  options.cohesion = bench.cohesion;
  options.rolling_friction = bench.rolling_friction;
  options.step = bench.step;
  options.threads = options.settle_threads = bench.threads;
  options.precision = bench.precision;
  options.activity = false;
  const terrain::dem::StableStep stable =
      terrain::dem::stable_at(options, terrain::dem::stated_overlap(options));
  if (bench.step > stable.step)
    throw input_error("command line", "--step",
                      fmt::format("is {:g} s, expected at most the stable step of {:.3g} s ({})", bench.step,
                                  stable.step, stable.reason));
  const std::vector<terrain::dem::Quad> bed = bed_of(bench, options, progress);
  options.periodic_x = true;

  const terrain::dem::SolverParams params = terrain::dem::solver_params(options);
  terrain::dem::GrainSolver solver(params);
  solver.place(bed);
  terrain::dem::SettleResult settled;
  if (bench.settle > 0.0) settled = terrain::dem::settle(solver, options, progress, bench.settle);
  solver.set_coefficients(terrain::dem::run_coefficients(options, bench.step));

  const auto steps = [&](const char* what, int count) {
    for (int k = 0; k < count; ++k) {
      progress(what, static_cast<double>(k) / count);
      if (solver.step(bench.step, k + 1 == count) >= 0)
        throw physics_error("a grain left the bin: the bed is not at rest with this law");
    }
  };
  steps("warming up", bench.warm);
  if (!bench.save.empty())
    terrain::dem::write_positions_csv(
        bench.save, std::span(solver.grains().position).first(solver.grains().count), 0.5 * kReferenceWidth);
  solver.reset_accounts();
  const double begin = wall_clock();
  steps("stepping", bench.steps);
  const double wall = wall_clock() - begin;

  const terrain::dem::Accounts& a = solver.accounts();
  const terrain::dem::Grains& grains = solver.grains();
  const double n = grains.count, contacts = static_cast<double>(a.contacts);
  std::int64_t listed = 0;
  for (int k = 0; k < solver.strips().count(); ++k) listed += solver.strips()[k].pairs;
  Hash hash;
  for (const auto* array : {&grains.position, &grains.velocity, &grains.spin})
    hash.add(std::span<const terrain::dem::Quad>(*array).first(grains.count));
  const nlohmann::ordered_json json = {
      {"grain_steps_per_s", n * bench.steps / wall},
      {"ms_per_step", 1e3 * wall / bench.steps},
      {"ns_per_contact", 1e9 * wall / bench.steps / contacts},
      {"grains", grains.count},
      {"contacts", a.contacts},
      {"coordination", 2.0 * contacts / n},
      {"pairs_listed_per_grain", static_cast<double>(listed) / n},
      {"floor_force_N", a.floor_force},
      {"weight_N", solver.relative_mass() * params.grain.mass * params.gravity},
      {"kinetic_energy_J", a.kinetic},
      {"force_residual", a.contact_force > 0.0 ? a.net_force / a.contact_force : 0.0},
      {"settled_s", settled.time},
      {"list_rebuilds", solver.rebuilds()},
      {"bytes_per_grain", static_cast<double>(solver.bytes()) / n},
      {"steps", bench.steps},
      {"threads", bench.threads},
      {"law", bench.law},
      {"precision", bench.precision},
      {"cohesion_Pa", bench.cohesion},
      {"rolling_friction", bench.rolling_friction},
      {"state_hash", hash.hex()}};
  return json.dump(2) + "\n";
}

}  // namespace furrow::commands
