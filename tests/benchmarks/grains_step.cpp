// How many grains a second the engine steps: settles a bed of the reference material (or takes it from the cache) and
// times steps on it. Prints one JSON object. Arguments: law radius length layers threads steps cohesion.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>

#include "terrain/dem/bed_layers.hpp"
#include "terrain/dem/bed_settling.hpp"

int main(int argc, char** argv) {
  using namespace furrow;
  using namespace furrow::dem;
  const auto argument = [&](int k, const char* otherwise) {
    return std::string(argc > k ? argv[k] : otherwise);
  };
  TerrainOptions options;
  options.law = argument(1, "mindlin");
  options.radius = std::atof(argument(2, "0.01").c_str());
  options.length = std::atof(argument(3, "2.65").c_str());
  options.layers = std::atoi(argument(4, "9").c_str());
  options.threads = std::atoi(argument(5, "1").c_str());
  const int steps = std::atoi(argument(6, "300").c_str());
  options.cohesion = std::atof(argument(7, "80e3").c_str());
  options.step = 6e-3 * options.radius;

  SolverParams params;
  params.law = law_from(options.law);
  params.grain = grain_properties(options.radius, options.density);
  params.bin = {options.length, options.width};
  params.skin = 0.3 * options.radius;
  params.threads = options.threads;
  GrainSolver solver(params);
  solver.place(bed_layers(params.bin, options.radius, options.layers, options.seed));
  const auto now = [] { return std::chrono::steady_clock::now(); };
  const auto seconds = [](auto from, auto to) { return std::chrono::duration<double>(to - from).count(); };
  const auto begin = now();
  const SettleResult settled = settle(solver, options, {});
  const auto middle = now();
  const std::clock_t cpu_begin = std::clock();
  const std::int64_t rebuilds = solver.pairs().rebuilds();
  for (int k = 0; k < steps; ++k) solver.step(options.step);
  const double wall = seconds(middle, now());
  const double cpu = static_cast<double>(std::clock() - cpu_begin) / CLOCKS_PER_SEC;

  const int n = solver.grains().count;
  double top = 0.0;
  for (int g = 0; g < n; ++g) top += solver.grains().position[g].z / n;
  std::printf(
      "{\"grain_steps_per_s\": %.4g, \"grain_steps_per_cpu_s\": %.4g, \"ms_per_step\": %.4g, \"grains\": %d, "
      "\"contacts\": %lld, \"threads\": %d, "
      "\"law\": \"%s\", \"list_rebuilds\": %lld, \"settled\": %s, \"settle_wall_s\": %.3g, "
      "\"settle_time_s\": %.3g, "
      "\"settle_steps\": %lld, \"force_ratio\": %.3g, \"floor_error\": %.3g, \"mean_z_m\": %.5g}\n",
      n * static_cast<double>(steps) / wall, n * static_cast<double>(steps) / cpu, 1e3 * wall / steps, n,
      static_cast<long long>(solver.accounts().contacts), options.threads, options.law.c_str(),
      static_cast<long long>(solver.pairs().rebuilds() - rebuilds), settled.settled ? "true" : "false",
      seconds(begin, middle), settled.time, static_cast<long long>(settled.steps), settled.force_ratio,
      settled.floor_error, top);
}
