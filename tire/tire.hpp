// The interface of every tire model: a deformable (or rigid) body held by a rim and pressed on by a terrain.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "protocol/core/archive.hpp"
#include "protocol/core/outcome.hpp"
#include "protocol/core/surface.hpp"
#include "tire/pressure_schedule.hpp"
#include "tire/rim_trajectory.hpp"

namespace furrow::tire {

/// Cumulative account of what a tire did since it was placed.
struct TireDiagnostics {
  double kinetic_energy = 0.0;         // J, now
  double strain_energy = 0.0;          // elastic − work of the pressure on the volume, J, now
  double dissipation = 0.0;            // structural damping and relaxation, J, cumulative
  Vec3 momentum = Vec3::Zero();        // kg m/s, now
  std::int64_t newton_iterations = 0;  // cumulative
  std::int64_t factorizations = 0;     // cumulative
  double residual = 0.0;               // free residual / reference at the last step's end
};

class Tire {
 public:
  virtual ~Tire() = default;

  virtual const SurfaceMesh& mesh() const = 0;
  virtual ContactMaterial material() const = 0;
  virtual MassProperties mass_properties() const = 0;
  virtual double radius() const = 0;       // of the undeformed contact surface, m
  virtual double tread_width() const = 0;  // m
  virtual int coordinates() const = 0;     // unknowns

  /// Gauge pressure from now on, Pa. A rigid tire does not mind.
  virtual void set_pressure(double pressure) = 0;

  /// Puts the tire on the rim, inflated, with the velocity field of a rigid body moving with the rim.
  /// @throws Error(physics) when inflation does not converge.
  virtual void place(const RimState& rim) = 0;

  /// Vertices at the current time.
  virtual void surface(SurfaceState& out) const = 0;

  /// Integrates from the trajectory's start to its end in `substeps` equal steps. `forces` act constantly; those that
  /// come with tangents answer to the motion, where the model can (TireOptions::contact_tangent).
  /// Gravity (0, 0, −9.81 m/s²) acts.
  /// @returns failure when the equations have no solution, a force is not finite, or the tire left the model's range
  /// @pre placed; substeps > 0; one force for each vertex, vertices of the mesh
  virtual Outcome advance(const RimTrajectory& rim, const NodalForces& forces, int substeps) = 0;

  /// Force and moment about the rim centre that the tire exerts on the rim, averaged over the last advance;
  /// complete, with the tire's inertia and weight, so that impulse = Δ momentum holds to round-off for the
  /// tire as a whole.
  virtual Wrench spindle_wrench() const = 0;

  /// Replaces the forces that the last advance was given by the means of what acted. They differ where tangents came
  /// with them.
  virtual void acted(NodalForces&) const {}

  virtual TireDiagnostics diagnostics() const = 0;

  /// State of the model and its integrator; a restored tire continues bit for bit.
  virtual void save(Archive& archive) const = 0;
  virtual void restore(const Archive& archive) = 0;
};

/// What a scenario says about a tire.
struct TireOptions {
  std::filesystem::path file;        // resolved
  PressureSchedule pressure;         // gauge, Pa; empty: the file's, constant
  double friction = -1.0;            // contact friction; negative: the file's
  int elements_circumference = 0;    // 0: the file's
  int elements_width = 0;            // 0: the file's; split over the sections in the file's proportions
  double structural_damping = -1.0;  // s; negative: the file's
  bool rigid = false;                // same surface, no deformation
  double substep = 0.0;              // s, time step the tire will be advanced with
  bool contact_tangent = false;      // contact forces answer to the tire's motion within the step
};

/// The tire file with the scenario's choices in place of its own. @throws Error(bad_input)
struct TireFile tire_file_of(const TireOptions& options);
/// The same for a file that was read already.
struct TireFile tire_file_of(const TireOptions& options, struct TireFile file);

/// Reads a tire file (our layout or the public ANCFTire layout) and makes the model it describes.
/// @throws Error(bad_input) naming file and key; a file of an unknown template lists the valid ones.
std::unique_ptr<Tire> make_tire(const TireOptions& options);

}  // namespace furrow::tire
