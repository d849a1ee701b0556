// A few grains on the emulated GPU, beside the same grains in the engine dem.
#pragma once

#include <vector>

#include "terrain/gpu/bed_transfer.hpp"
#include "terrain/gpu/gpu_grains.hpp"
#include "tests/terrain/few_grains.hpp"

namespace furrow::terrain::gpu {

struct SteppedGrains {
  GpuGrains grains;
  GrainMotion at;  // after the last run()

  /// The grains of a solver, with their histories. @param order of the threads
  explicit SteppedGrains(const dem::GrainSolver& solver, int order = 0) : grains(solver.params(), order) {
    grains.set_coefficients(solver.coefficients());
    send_bed(solver, grains);
    at = grains.motion(true);
  }
  RunResult run(double dt, int steps, double drag = 0.0) {
    const RunResult result = grains.run({steps, dt, dt, 0.0, 0.0, INFINITY, drag});
    at = grains.motion(true);
    return result;
  }
  std::uint64_t hash() const {
    Hash hash;
    for (const auto* a : {&at.position, &at.velocity, &at.spin}) hash.add(std::span(*a));
    return hash.value();
  }
  Vec3 momentum(double mass) const {
    Vec3 sum = Vec3::Zero();
    for (const Vec3& v : at.velocity) sum += mass * v;
    return sum;
  }
};

}  // namespace furrow::terrain::gpu
