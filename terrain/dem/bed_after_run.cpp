#include "terrain/dem/bed_after_run.hpp"

#include <cmath>
#include <string>

#include "protocol/error.hpp"
#include "terrain/dem/bed_preparation.hpp"
#include "terrain/dem/bed_settling.hpp"
#include "terrain/dem/solver_setup.hpp"

namespace furrow::dem {
namespace {

constexpr char kPrefix[] = "terrain/";

/// The solver's part of the state, without surfaces.
Archive grains_of(const Archive& state) {
  Archive grains;
  for (const auto& [name, values] : state.arrays()) {
    if (!name.starts_with(kPrefix)) continue;
    const std::string own = name.substr(sizeof kPrefix - 1);
    if (!own.starts_with("surface")) grains.put_array(own, values);
  }
  grains.put("surfaces/count", std::int64_t{0});
  grains.put("surfaces/keys", std::vector<std::int32_t>());
  grains.put("surfaces/history", std::vector<double>());
  return grains;
}

}  // namespace

Archive bed_after_run(const Archive& state, const TerrainOptions& options, double rest, RestResult& result) {
  SolverParams params = solver_params(options);
  params.threads = std::max(1, options.threads);
  GrainSolver solver(params);
  solver.restore(grains_of(state));
  const double dt = options.step;
  solver.set_coefficients(run_coefficients(options, dt));
  const auto steps = static_cast<std::int64_t>(std::ceil(rest / dt));
  for (std::int64_t n = 1; n <= steps; ++n)
    if (const int lost = solver.step(dt, n == steps); lost >= 0)
      throw physics_error("grain " + std::to_string(solver.grains().id[lost]) +
                          " was lost while the bed lay");
  const Accounts& a = solver.accounts();
  const double mass = params.grain.mass * solver.relative_mass(), weight = mass * params.gravity;
  result.force_ratio = a.contact_force > 0.0 ? a.net_force / a.contact_force : 1.0;
  result.floor_error = std::abs(a.floor_force - weight) / weight;
  result.speed = std::sqrt(2.0 * a.kinetic / mass);
  SettleResult settled;
  settled.settled = result.force_ratio < kSettledForceRatio;
  settled.force_ratio = result.force_ratio;
  settled.floor_error = result.floor_error;
  settled.time = rest;
  return bed_archive(solver, options, settled);
}

}  // namespace furrow::dem
