#include "terrain/dem/beds/bed_after_run.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "protocol/core/paced_call.hpp"
#include "terrain/dem/beds/bed_preparation.hpp"
#include "terrain/dem/beds/bed_settling.hpp"
#include "terrain/dem/solver_setup.hpp"

namespace furrow::terrain::dem {
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
  SurfaceContacts({}, 0.0, {}, false).save(grains);
  return grains;
}

}  // namespace

Archive bed_after_run(const Archive& state, const DemOptions& options, double rest, const ProgressCall& progress,
                      SettleResult& result) {
  FURROW_ASSERT(rest >= 0.0 && options.step > 0.0, rest, options.step);
  SolverParams params = solver_params(options);
  params.threads = std::max(1, options.threads);
  GrainSolver solver(params);
  solver.restore(grains_of(state));
  result = {};
  const double dt = options.step;
  solver.set_coefficients(run_coefficients(options, dt));
  const auto resting = static_cast<std::int64_t>(std::ceil(rest / dt));
  const auto most = resting + static_cast<std::int64_t>(kMaxSettleTime / dt);
  PacedCall tell(progress);
  for (std::int64_t n = 0; n < most && !result.settled; ++n) {
    tell("letting the bed lie", static_cast<double>(n) / static_cast<double>(most));
    if (n == resting) solver.set_drag(kRestDrag);
    const bool check = (n + 1) % kSettleCheckEvery == 0;
    if (const int lost = solver.step(dt, check); lost >= 0)
      throw physics_error("grain " + std::to_string(solver.grains().id[lost]) + " was lost while the bed lay");
    if (!check) continue;
    result.time = dt * static_cast<double>(n + 1);
    measure_rest(solver, result);
    result.settled = n >= resting && result.speed < kRestSpeed && result.force_ratio < kSettledForceRatio;
  }
  solver.set_drag(0.0);
  return bed_archive(solver, options, result);
}

}  // namespace furrow::terrain::dem
