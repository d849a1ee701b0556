// A bed of grains for comparisons with another program: the engine's solver with the settings of a job file, and groups
// of grains with imposed motion, which serve as rough plates.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <vector>

#include <nlohmann/json.hpp>

#include "terrain/dem/dem_options.hpp"
#include "terrain/dem/grain_solver.hpp"

namespace furrow::peers {

using Job = nlohmann::json;

/// The first column of the start positions: the kind of a grain.
enum Kind : int { kFree = 0, kBase = 1, kLid = 2 };

/// Grains that move as one rigid body without turning.
struct Plate {
  int grains = 0;
  Vec3 velocity = Vec3::Zero();  // of the next step, m/s
  Vec3 force = Vec3::Zero();     // of the other grains on it, last step, N
};

class PeerBed {
 public:
  /// Keys of the job: start (CSV kind,x_m,y_m,z_m), length, width, periodic_x, periodic_y, radius, density,
  /// young_modulus, poisson_ratio, restitution, friction, wall_friction, cohesion, precision, step, half_step_start,
  /// switches and damper_mass ("sliding": 2/7 m*, or "full": m*) of the law. Walls have no cohesion.
  explicit PeerBed(const Job& job);

  /// Makes one step. After the forces, `drive` may change the plates' velocities for this step's motion.
  /// @throws Error(physics) when a grain is lost
  void step(const std::function<void()>& drive = {});

  double dt() const { return step_; }                                     // s
  double area() const { return params_.bin.length * params_.bin.width; }  // m²
  terrain::dem::GrainSolver& solver() { return solver_; }
  const terrain::dem::SolverCoefficients& coefficients() const { return solver_.coefficients(); }
  Plate& plate(Kind kind) { return plates_[kind]; }
  /// Appends x y z of each grain in the order of the start file to `out`, m.
  void positions(std::vector<double>& out) const;

 private:
  terrain::dem::DemOptions options_;
  double step_;
  terrain::dem::SolverParams params_;
  terrain::dem::GrainSolver solver_;
  std::vector<int> kind_;  // by id
  std::array<Plate, 3> plates_;
};

}  // namespace furrow::peers
