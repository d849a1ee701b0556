// A settled bed in a solver, and a plate that moves on it.
#pragma once

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "terrain/dem/beds/bed_layers.hpp"
#include "terrain/dem/beds/bed_settling.hpp"
#include "terrain/dem/solver_setup.hpp"
#include "tests/terrain/few_grains.hpp"
#include "tests/terrain/surface_meshes.hpp"

namespace furrow::terrain::dem {

/// A settled bed, without activity so far.
inline Archive settled_bed(const DemOptions& options) {
  GrainSolver solver(settling_params(options));
  solver.place(bed_layers(solver.params().bin, options.radius, options.layers, 1));
  settle(solver, options, {});
  Archive archive;
  solver.save(archive);
  return archive;
}

inline GrainSolver solver_of(const DemOptions& options, const Archive& bed, bool activity) {
  SolverParams params = solver_params(options);
  params.activity = activity;
  GrainSolver solver(params);
  solver.restore(bed);
  solver.set_coefficients(run_coefficients(options, options.step));
  return solver;
}

/// A horizontal plate with a lower side as rough as rubber.
class Plate {
 public:
  Plate(GrainSolver& solver, DemOptions options, const testing::Surface& shape)
      : solver_(solver), options_(std::move(options)), state_(testing::at_rest(shape)) {
    const ContactMaterial rubber{2e7, 0.4, 0.9, 0.2, 2e6, 13.0, 0.0};
    solver.surfaces().attach(shape.mesh, rubber, mixed(rubber), state_);
    restrict();
  }
  /// The plate of a saved solver, in the solver that was restored from it.
  Plate(GrainSolver& restored, const Plate& saved) : solver_(restored), options_(saved.options_), state_(saved.state_) {
    restored.surfaces().set_coefficients(0, mixed(restored.surfaces().material(0)));
    restrict();
  }

  /// Steps while the plate moves. @returns the mean force on it, N
  Vec3 move(const Vec3& velocity, int steps) {
    const double dt = options_.step;
    std::vector<NodalForces> nodal(1);
    std::vector<ContactSums> sums(1);
    Vec3 mean = Vec3::Zero();
    for (int k = 0; k < steps; ++k) {
      for (Vec3& v : state_.velocity) v = velocity;
      solver_.surfaces().set_targets({&state_, 1}, dt);
      solver_.surfaces().move_to(0.0);
      EXPECT_EQ(solver_.step(dt), -1);
      solver_.surfaces().move_to(1.0);
      solver_.surfaces().finish(dt, nodal, sums);
      for (Vec3& x : state_.position) x += dt * velocity;
      mean += sums[0].force / steps;
      work += sums[0].work;
    }
    return mean;
  }

  double work = 0.0;  // of the terrain on it, J

 private:
  ContactCoefficients mixed(const ContactMaterial& material) const {
    return mix(grain_material(options_), material, Partner::surface, solver_.params().grain, options_);
  }
  void restrict() { solver_.surfaces().restrict_to({Vec3(-1, -2, -1), Vec3(2, 2, solver_.top() + 0.1)}); }

  GrainSolver& solver_;
  DemOptions options_;
  SurfaceState state_;
};

/// Largest difference of the vertical forces on two plates that move down at 0.1 m/s in 20 stretches of 100 steps, and
/// the largest force on the second, N.
inline std::pair<double, double> difference_pressed(Plate& one, Plate& other) {
  double error = 0.0, most = 0.0;
  for (int n = 0; n < 20; ++n) {
    const double a = one.move(Vec3(0, 0, -0.1), 100).z(), b = other.move(Vec3(0, 0, -0.1), 100).z();
    most = std::max(most, b);
    error = std::max(error, std::abs(a - b));
  }
  return {error, most};
}

}  // namespace furrow::terrain::dem
