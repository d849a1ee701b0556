#include "terrain/dem/beds/bed_compaction.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "protocol/core/paced_call.hpp"
#include "terrain/dem/beds/bed_settling.hpp"
#include "terrain/dem/beds/loaded_lid.hpp"

namespace furrow::terrain::dem {
namespace {

constexpr double kPressSpeed = 1.0;     // m/s: the load grows in the time depth of the bed / this speed
constexpr double kMaxHold = 8.0;        // in units of that time
constexpr double kLidAtRest = 1e-3;     // m/s: a slower lid counts as at rest
constexpr double kSolidFraction = 0.5;  // of a loose bed, for the lid's mass

struct Lid {
  SurfaceMesh mesh;
  SurfaceState state;
};

/// A lid that fills the bin at height z, its outside down.
Lid lid_at(const Bin& bin, double z) {
  Lid lid;
  const double half = 0.5 * bin.width;
  lid.state.position = {{0.0, -half, z}, {bin.length, -half, z}, {bin.length, half, z}, {0.0, half, z}};
  lid.state.velocity.assign(4, Vec3::Zero());
  lid.mesh.vertex_count = 4;
  lid.mesh.triangles = {{0, 2, 1}, {0, 3, 2}};
  return lid;
}

double top_of(const GrainSolver& solver) {
  double top = 0.0;
  for (int g = 0; g < solver.grains().count; ++g)
    top = std::max(top, solver.grains().position[g].z + solver.grains().position[g].w);
  return top;
}

}  // namespace

std::vector<Quad> positions_by_id(const GrainSolver& solver) {
  FURROW_ASSERT(solver.grains().id.size() == static_cast<std::size_t>(solver.grains().count),
                solver.grains().id.size());
  const Grains& grains = solver.grains();
  std::vector<Quad> positions(grains.count);
  for (int g = 0; g < grains.count; ++g) positions[grains.id[g]] = grains.position[g];
  return positions;
}

std::vector<Quad> compacted_positions(GrainSolver& solver, const DemOptions& options, const ProgressCall& progress) {
  FURROW_ASSERT(options.compaction_pressure > 0.0, options.compaction_pressure);
  FURROW_ASSERT(solver.grains().count > 0, solver.grains().count);
  const Bin& bin = solver.params().bin;
  const double dt = settle_step(options), depth = top_of(solver), area = bin.length * bin.width;
  const double load = options.compaction_pressure * area;
  LoadedLid body(area, options.compaction_pressure, kSolidFraction * options.density, depth, grain_modulus(options));
  Lid lid = lid_at(bin, depth);
  solver.set_coefficients(settle_coefficients(options));
  DemOptions smooth = options;
  smooth.friction = smooth.rolling_friction = smooth.cohesion = 0.0;
  SurfaceContacts& surfaces = solver.surfaces();
  surfaces.attach(lid.mesh, grain_material(options), settle_coefficients(smooth).floor, lid.state);

  std::vector<NodalForces> forces(1);
  std::vector<ContactSums> sums(1);
  const double grow = depth / kPressSpeed;
  PacedCall tell(progress);
  double force = 0.0;
  const auto step = [&](double share) {
    const double velocity = body.step(force, share * load, dt);
    lid.state.velocity.assign(4, Vec3(0.0, 0.0, velocity));
    surfaces.set_targets({&lid.state, 1}, dt);
    surfaces.move_to(0.0);
    if (const int lost = solver.step(dt); lost >= 0)
      throw physics_error("grain " + std::to_string(solver.grains().id[lost]) +
                          " was lost while the bed was compacted, expected a lower compaction_pressure");
    surfaces.move_to(1.0);
    surfaces.finish(dt, forces, sums);
    force = sums[0].force.z();
    for (Vec3& x : lid.state.position) x.z() += dt * velocity;
  };
  const auto phase = [&](double seconds, double from, const auto& share, bool until_rest) {
    const auto steps = static_cast<std::int64_t>(std::ceil(seconds / dt));
    for (std::int64_t k = 0; k < steps; ++k) {
      const double done = static_cast<double>(k + 1) / static_cast<double>(steps);
      step(share(done));
      tell("compacting the bed", from + 0.3 * done);
      const bool bears = std::abs(force - load) < 0.01 * load;
      if (until_rest && bears && std::abs(body.velocity()) < kLidAtRest) return;
    }
  };
  phase(
      grow, 0.0, [](double done) { return done; }, false);
  phase(
      kMaxHold * grow, 0.3, [](double) { return 1.0; }, true);
  phase(
      grow, 0.6, [](double done) { return 1.0 - done; }, false);
  return positions_by_id(solver);
}

}  // namespace furrow::terrain::dem
