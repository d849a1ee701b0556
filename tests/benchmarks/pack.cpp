// Microseconds to pack and unpack the surface of a tire, by its number of vertices.
#include <benchmark/benchmark.h>

#include "protocol/transport.hpp"

namespace {

void pack_surface(benchmark::State& state) {
  furrow::SurfaceMotion motion;
  for (int i = 0; i < state.range(0); ++i) {
    motion.surface.position.emplace_back(i, 0.1 * i, 0.0);
    motion.surface.velocity.emplace_back(0.0, -i, 1.0);
  }
  for (auto _ : state) benchmark::DoNotOptimize(furrow::unpack<furrow::SurfaceMotion>(furrow::pack(motion)));
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations()) * state.range(0) * 48);
}
BENCHMARK(pack_surface)->Arg(1'000)->Arg(10'000)->Unit(benchmark::kMicrosecond);

}  // namespace
