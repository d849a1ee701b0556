#include "terrain/dem/grain_bench.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "protocol/core/clock.hpp"
#include "protocol/core/error.hpp"
#include "protocol/core/hash.hpp"
#include "terrain/dem/beds/bed_csv.hpp"
#include "terrain/dem/beds/bed_generators.hpp"
#include "terrain/dem/beds/bed_settling.hpp"
#include "terrain/dem/dem_terrain.hpp"
#include "terrain/dem/solver_setup.hpp"
#include "terrain/gpu/bed_transfer.hpp"
#include "terrain/gpu/gpu_grains.hpp"

namespace furrow::terrain::dem {
namespace {

constexpr double kReferenceWidth = 0.6;  // m
constexpr double kLongest = 1000.0;      // m

std::vector<Quad> reference_bed(const DemOptions& options, const ProgressCall& progress) {
  const auto terrain = make_dem_terrain(options);
  terrain->prepare(progress);
  Archive archive;
  terrain->save(archive);
  const auto& x = archive.get<double>("terrain/position");
  std::vector<Quad> grains;
  for (std::size_t k = 0; k + 3 < x.size(); k += 4) grains.push_back({x[k], x[k + 1], x[k + 2], x[k + 3]});
  return grains;
}

/// Positions of the bed; sets `options` to those of its bin.
std::vector<Quad> bed_of(const GrainBench& bench, DemOptions& options, const ProgressCall& progress) {
  options.width = kReferenceWidth;
  if (bench.bed == "default") return reference_bed(options, progress);
  std::vector<Quad> grains = read_positions_csv(bench.bed, progress);
  double longest = 0.0;
  for (std::size_t k = 0; k < grains.size(); ++k) {
    Quad& p = grains[k];
    if (!(p.x >= 0.0 && p.y >= 0.0 && p.y <= kReferenceWidth))
      throw input_error(
          bench.bed, fmt::format("line {}", k + 2),
          fmt::format("the grain is outside the bin, expected x from 0 m on, y 0 to {:g} m", kReferenceWidth));
    if (p.x > kLongest)
      throw input_error(bench.bed, fmt::format("line {}", k + 2),
                        fmt::format("x is {:g} m, expected at most {:g} m", p.x, kLongest));
    longest = std::max(longest, p.x);
    p.y -= 0.5 * kReferenceWidth;
  }
  options.length = std::max(1.0, std::ceil(longest));
  options.periodic_x = true;
  check_positions(options, bench.bed, grains, progress);
  return grains;
}

std::string state_hash(const Grains& grains) {
  Hash hash;
  for (const auto* array : {&grains.position, &grains.velocity, &grains.spin})
    hash.add(std::span<const Quad>(*array).first(grains.count));
  return hash.hex();
}

[[noreturn]] void not_at_rest() { throw physics_error("a grain left the bin: the bed is not at rest with this law"); }

void time_on_cpu(const GrainBench& bench, const DemOptions& options, GrainSolver& solver, const ProgressCall& progress,
                 GrainBenchResult& result) {
  const auto steps = [&](const char* what, int count) {
    for (int k = 0; k < count; ++k) {
      progress(what, static_cast<double>(k) / count);
      if (solver.step(options.step, k + 1 == count) >= 0) not_at_rest();
    }
  };
  steps("warming up", bench.warm);
  if (!bench.save.empty())
    write_positions_csv(bench.save, std::span(solver.grains().position).first(solver.grains().count),
                        0.5 * kReferenceWidth);
  solver.reset_accounts();
  const double begin = wall_clock();
  steps("stepping", bench.steps);
  result.wall = wall_clock() - begin;

  const Accounts& a = solver.accounts();
  result.device = "cpu";
  result.contacts = a.contacts;
  for (int k = 0; k < solver.strips().count(); ++k) result.pairs_listed += solver.strips()[k].pairs;
  result.floor_force = a.floor_force;
  result.kinetic_energy = a.kinetic;
  result.force_residual = a.contact_force > 0.0 ? a.net_force / a.contact_force : 0.0;
  result.list_rebuilds = solver.rebuilds();
  result.bytes = static_cast<double>(solver.bytes());
  result.state_hash = state_hash(solver.grains());
}

void time_on_gpu(const GrainBench& bench, const DemOptions& options, const GrainSolver& solver,
                 const ProgressCall& progress, GrainBenchResult& result) {
  const gpu::DeviceInfo info = gpu::gpu_device();
  result.device = info.name;
  result.driver = info.driver;
  gpu::GpuGrains grains(solver.params());
  grains.set_coefficients(solver.coefficients());
  gpu::send_bed(solver, grains);
  const auto steps = [&](const char* what, int count) {
    progress(what, 0.0);
    const double dt = options.step;
    if (grains.run({count, dt, dt, 0.0, 0.0, std::numeric_limits<double>::infinity(), 0.0}).lost >= 0) not_at_rest();
  };
  if (bench.warm > 0) steps("warming up", bench.warm);
  if (!bench.save.empty()) {
    std::vector<Quad> positions;
    for (const Vec3& x : grains.motion(false).position) positions.push_back({x.x(), x.y(), x.z(), options.radius});
    write_positions_csv(bench.save, positions, 0.5 * kReferenceWidth);
  }
  const auto rebuilds = static_cast<double>(grains.sums(false, options.step).rebuilds);
  const double begin = wall_clock();
  steps("stepping", bench.steps);
  result.wall = wall_clock() - begin;

  const gpu::Sums s = grains.sums(false, options.step);
  result.contacts = std::llround(s.contacts);
  result.pairs_listed = std::llround(s.listed);
  result.floor_force = s.floor_force;
  result.kinetic_energy = 0.5 * (solver.params().grain.mass * s.speed2 + solver.params().grain.inertia * s.spin2);
  result.force_residual = s.contact_force > 0.0 ? s.net_force / s.contact_force : 0.0;
  result.list_rebuilds = static_cast<double>(s.rebuilds) - rebuilds;
  result.bytes = static_cast<double>(s.bytes);
  const gpu::GrainMotion at = grains.motion(true);
  Hash hash;
  for (const auto* array : {&at.position, &at.velocity, &at.spin}) hash.add(std::span<const Vec3>(*array));
  result.state_hash = hash.hex();
}

}  // namespace

GrainBenchResult run_grain_bench(const GrainBench& bench, const ProgressCall& progress) {
  DemOptions options = bench.grains;
  options.activity = false;
  const std::vector<Quad> bed = bed_of(bench, options, progress);
  options.periodic_x = true;

  const SolverParams params = solver_params(options);
  GrainSolver solver(params);
  solver.place(bed);
  GrainBenchResult result;
  if (bench.settle > 0.0) result.settled = settle(solver, options, progress, bench.settle).time;
  solver.set_coefficients(run_coefficients(options, options.step));
  result.grains = solver.grains().count;
  result.weight = solver.relative_mass() * params.grain.mass * -params.gravity.z();
  options.on_gpu() ? time_on_gpu(bench, options, solver, progress, result)
                   : time_on_cpu(bench, options, solver, progress, result);
  return result;
}

}  // namespace furrow::terrain::dem
