#include "terrain/dem/beds/bed_settling.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "protocol/core/paced_call.hpp"
#include "terrain/dem/solver_setup.hpp"
#include "terrain/gpu/bed_transfer.hpp"
#include "terrain/gpu/gpu_grains.hpp"

namespace furrow::terrain::dem {
namespace {

constexpr double kStepShare = 0.8;         // of the stable step, with a law that has history
constexpr double kStepShareWithout = 0.7;  // without history, falling grains overlap more
constexpr double kLyingSpeed = 0.03;       // rms, m/s: a slower bed gets the drag of lying grains

DemOptions with_impulse_limit(DemOptions options) {
  options.friction_impulse_limit = true;
  return options;
}

double weight_of(const GrainSolver& solver) {
  const double mass = solver.params().grain.mass * solver.relative_mass();
  return -mass * solver.params().gravity.z();
}

void measure_rest(const GrainSolver& solver, const Accounts& a, SettleResult& result) {
  const double mass = solver.params().grain.mass * solver.relative_mass(), weight = weight_of(solver);
  result.force_ratio = a.contact_force > 0.0 ? a.net_force / a.contact_force : 1.0;
  result.floor_error = std::abs(a.floor_force - weight) / weight;
  result.speed = std::sqrt(2.0 * a.kinetic / mass);
}

/// The solver's grains while a GPU steps them.
class OnGpu {
 public:
  explicit OnGpu(const GrainSolver& solver) : solver_(solver), grains_(solver.params()) {
    grains_.set_coefficients(solver.coefficients());
    gpu::send_bed(solver, grains_);
  }
  /// @returns the number of a grain that was lost, or −1
  int step(double dt, int steps, double drag) {
    return grains_.run({steps, dt, dt, 0.0, 0.0, std::numeric_limits<double>::infinity(), drag}).lost;
  }
  Accounts accounts(double dt) {
    const gpu::Sums s = grains_.sums(false, dt);
    const GrainProperties& grain = solver_.params().grain;
    Accounts a;
    a.kinetic = 0.5 * (grain.mass * s.speed2 + grain.inertia * s.spin2);
    a.contacts = std::llround(s.contacts);
    a.contact_force = s.contact_force, a.net_force = s.net_force, a.floor_force = s.floor_force;
    return a;
  }
  void fetch(GrainSolver& solver) const { gpu::fetch_bed(grains_, solver); }

 private:
  const GrainSolver& solver_;
  gpu::GpuGrains grains_;
};

int id_of(const GrainSolver& solver, int index) { return index < 0 ? -1 : solver.grains().id[index]; }

}  // namespace

void measure_rest(const GrainSolver& solver, SettleResult& result) { measure_rest(solver, solver.accounts(), result); }

double settle_step(const DemOptions& options) {
  const DemOptions limited = with_impulse_limit(options);
  const double share = has_history(law_from(options.law)) ? kStepShare : kStepShareWithout;
  return share * stable_at(limited, stated_overlap(limited)).step;
}

SolverCoefficients settle_coefficients(const DemOptions& options) {
  const double dt = settle_step(options);
  DemOptions smooth = with_impulse_limit(options);
  SolverCoefficients c = run_coefficients(smooth, dt);
  smooth.friction = smooth.rolling_friction = 0.0;
  c.side = run_coefficients(smooth, dt).side;
  return c;
}

SettleResult settle(GrainSolver& solver, const DemOptions& options, const ProgressCall& progress, double most_time,
                    double drag) {
  FURROW_ASSERT(most_time > 0.0 && drag >= 0.0, most_time, drag);
  SettleResult result;
  const double dt = settle_step(options);
  const GrainProperties& grain = solver.params().grain;
  const double weight = weight_of(solver);
  solver.set_coefficients(settle_coefficients(options));
  double drag_now = drag;
  solver.set_drag(drag);
  std::optional<OnGpu> on_gpu;
  if (options.on_gpu()) on_gpu.emplace(solver);
  bool lying = false;
  bool all_awake = !solver.params().activity || on_gpu;  // at the next check
  static_assert(kSettleCheckEvery < kCalmSteps, "grains that were woken at a check are awake at the next one");
  double best = 1.0, share = 0.0;
  PacedCall tell(progress);
  const auto most = static_cast<std::int64_t>(most_time / dt);
  while (result.steps < most && !result.settled) {
    tell("settling the bed", share);
    const int taken = on_gpu ? static_cast<int>(std::min<std::int64_t>(kSettleCheckEvery, most - result.steps)) : 1;
    result.steps += taken;
    const bool check = result.steps % kSettleCheckEvery == 0;
    const int lost = on_gpu ? on_gpu->step(dt, taken, drag_now) : id_of(solver, solver.step(dt, check));
    if (lost >= 0) throw physics_error("grain " + std::to_string(lost) + " was lost while the bed settled");
    if (!check) continue;
    const Accounts a = on_gpu ? on_gpu->accounts(dt) : solver.accounts();
    measure_rest(solver, a, result);
    result.time = dt * static_cast<double>(result.steps);
    // This only helps a bed of many contacts; one with few comes to rest without it.
    if (!lying && a.contacts > solver.grains().count && result.speed < kLyingSpeed) {
      lying = true;
      drag_now = std::max(kRestDrag, drag);
      solver.set_drag(drag_now);
    }
    const bool rests = result.speed < kRestSpeed && a.kinetic < kRestEnergy * weight * grain.radius &&
                       result.force_ratio < kSettledForceRatio;
    result.settled = rests && result.floor_error < kSettledFloorError && all_awake;
    // After the first rest no grain sleeps: sleeping grains may support others that the floor does not carry yet.
    if (solver.params().activity && !on_gpu && (rests || all_awake)) {
      all_awake = true;
      solver.wake_all();
    }
    best = std::min(best, std::max(result.force_ratio, result.floor_error));
    const double decades = std::log10(1.0 / std::max(best, kSettledForceRatio)) / 3.0;
    share = std::clamp(std::max(decades, dt * result.steps / most_time), 0.0, 1.0);
  }
  if (on_gpu) on_gpu->fetch(solver);
  solver.set_drag(0.0);
  return result;
}

}  // namespace furrow::terrain::dem
