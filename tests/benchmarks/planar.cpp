// The planar tire on one core: element-steps per millisecond, share of real time, accuracy of its integrators.
#include <benchmark/benchmark.h>

#include <cmath>

#include "tests/tire/planar/planar_wheel.hpp"

namespace {

using namespace furrow::tire;

PlanarParams wheel_params(std::int64_t around, std::int64_t runge_kutta) {
  PlanarParams p;
  p.size = {
      .radius = 0.52, .rim_radius = 0.254, .rings = static_cast<int>(around) / 9, .around = static_cast<int>(around)};
  p.disc = {740.0, 1e8, 0.3, 0.0}, p.tire = {93.0, 3e5, 0.45, 100.0};
  p.integrator = runge_kutta != 0 ? PlanarIntegrator::runge_kutta_4 : PlanarIntegrator::semi_implicit_euler;
  p.contact_stiffness = 1e6, p.friction = 0.8;
  return p;
}

/// @param state elements around; whether volumes are averaged; whether Runge and Kutta's method is used
void rolling(benchmark::State& state) {
  PlanarParams p = wheel_params(state.range(0), state.range(2));
  p.options.averaged = state.range(1) != 0;
  PlanarWheel wheel(p, PlanarGround::plate(50.0), {0.0, 0.51}, {3.0, 0.0}, 3.0 / 0.52, 100.0, 9.81);
  for (auto _ : state)
    if (!wheel.advance().ok) state.SkipWithError("the wheel failed");
  state.counters["elements"] = wheel.mesh().elements();
  state.counters["element_steps_per_ms"] = benchmark::Counter(
      1e-3 * static_cast<double>(state.iterations()) * wheel.mesh().elements(), benchmark::Counter::kIsRate);
  state.counters["of_real_time"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * wheel.step(), benchmark::Counter::kIsRate);
}
BENCHMARK(rolling)
    ->Args({36, 0, 0})
    ->Args({72, 0, 0})
    ->Args({144, 0, 0})
    ->Args({72, 1, 0})
    ->Args({72, 0, 1})
    ->Unit(benchmark::kMicrosecond);

/// Height of the centre 50 ms after the wheel meets a plate at 1 m/s, m.
double height_after_impact(bool runge_kutta, double step_share) {
  PlanarParams p = wheel_params(36, runge_kutta);
  p.step_share = step_share;
  PlanarWheel wheel(p, PlanarGround::plate(50.0), {0.0, p.size.radius}, {0.0, -1.0}, 0.0, 100.0, 9.81);
  const double end = 0.05;
  double time = 0.0;
  for (; time + wheel.step() <= end && wheel.advance().ok; time += wheel.step()) {
  }
  return wheel.centre().z + (end - time) * wheel.centre_velocity().z;
}

/// @param state whether Runge and Kutta's method is used; steps of the largest stable one's sixteenths
void accuracy(benchmark::State& state) {
  static const double exact = height_after_impact(true, 1.0 / 64.0);
  double height = 0.0;
  for (auto _ : state) height = height_after_impact(state.range(0) != 0, static_cast<double>(state.range(1)) / 16.0);
  state.counters["error_m"] = std::abs(height - exact);
}
BENCHMARK(accuracy)->ArgsProduct({{0, 1}, {1, 2, 4, 8}})->Unit(benchmark::kMillisecond);

}  // namespace
