// Element-steps per millisecond of the planar tire, on one core.
#include <benchmark/benchmark.h>

#include "tests/tire/planar/planar_wheel.hpp"

namespace {

using namespace furrow::tire;

/// @param state elements around; whether volumes are averaged; whether Runge and Kutta's method is used
void rolling(benchmark::State& state) {
  PlanarParams p;
  p.size = {.radius = 0.52,
            .rim_radius = 0.254,
            .rings = static_cast<int>(state.range(0)) / 9,
            .around = static_cast<int>(state.range(0))};
  p.disc = {740.0, 1e8, 0.3, 0.0}, p.tire = {93.0, 3e5, 0.45, 100.0};
  p.options.averaged = state.range(1) != 0;
  p.integrator = state.range(2) != 0 ? PlanarIntegrator::runge_kutta_4 : PlanarIntegrator::semi_implicit_euler;
  p.contact_stiffness = 1e6, p.friction = 0.8;
  PlanarWheel wheel(p, PlanarGround::plate(50.0), {0.0, 0.51}, {3.0, 0.0}, 3.0 / 0.52, 100.0, 9.81);
  for (auto _ : state)
    if (!wheel.advance().ok) state.SkipWithError("the wheel failed");
  state.counters["elements"] = wheel.mesh().elements();
  state.counters["element_steps_per_ms"] = benchmark::Counter(
      1e-3 * static_cast<double>(state.iterations()) * wheel.mesh().elements(), benchmark::Counter::kIsRate);
}
BENCHMARK(rolling)
    ->Args({72, 0, 0})
    ->Args({144, 0, 0})
    ->Args({72, 1, 0})
    ->Args({72, 0, 1})
    ->Unit(benchmark::kMicrosecond);

}  // namespace
