// Milliseconds that the flexible ring needs for a load–deflection curve of 40 points, on one core.
#include <benchmark/benchmark.h>

#include "tire/ring/ring_solver.hpp"

namespace {

using namespace furrow::tire;

RingParams truck_ring(int segments) {
  RingParams p;
  p.segments = segments;
  p.radius = 0.39, p.width = 0.2, p.air_share = 0.35, p.pressure = 300e3;
  p.bending = 800.0, p.shear = 4e4, p.tangential = 2e5;
  p.sidewall_1 = 4e5, p.sidewall_2 = 6e6, p.sidewall_3 = 6e7;
  return p;
}

/// @param state segments; width of a cleat in mm, 0 for a plate; percentage of the pressure that the belt carries
void loading_curve(benchmark::State& state) {
  constexpr int kPoints = 40;
  constexpr double kDeflection = 0.095;  // m
  RingParams params = truck_ring(static_cast<int>(state.range(0)));
  params.tension_share = 1e-2 * static_cast<double>(state.range(2));
  const double width = 1e-3 * static_cast<double>(state.range(1));
  int systems = 0;
  for (auto _ : state) {
    systems = 0;
    RingSolver solver(params, width > 0.0 ? RingGround::bar(width, 0.0) : RingGround::plate(params.radius));
    for (int k = 1; k <= kPoints; ++k) {
      const RingReport report = solver.solve({0.0, params.radius - kDeflection * k / kPoints});
      if (!report.converged) state.SkipWithError("no equilibrium");
      systems += report.systems;
    }
    benchmark::DoNotOptimize(solver.spindle_force().z);
  }
  state.counters["systems"] = systems;
}
BENCHMARK(loading_curve)
    ->ArgNames({"segments", "cleat_mm", "tension_percent"})
    ->Args({480, 0, 0})
    ->Args({480, 25, 0})
    ->Args({480, 51, 0})
    ->Args({480, 100, 0})
    ->Args({1920, 0, 0})
    ->Args({480, 0, 40})
    ->Args({480, 51, 40})
    ->Unit(benchmark::kMillisecond);

}  // namespace
