// The interface of every tire model: a deformable or rigid body that a rim holds and a terrain presses.
#pragma once

#include <utility>
#include <vector>

#include "protocol/core/archive.hpp"
#include "protocol/core/hash.hpp"
#include "protocol/core/outcome.hpp"
#include "protocol/core/stated_contact.hpp"
#include "protocol/core/surface.hpp"
#include "protocol/core/tire_diagnostics.hpp"
#include "tire/named_values.hpp"
#include "tire/rim_trajectory.hpp"

namespace furrow::tire {

using furrow::TireDiagnostics;

/// The undeformed tire in rim axes, origin at the rim's centre.
struct TireShape {
  SurfaceMesh mesh;
  std::vector<Vec3> vertex;  // m
  ContactMaterial material;
  MassProperties mass;
  double radius = 0.0;       // m
  double tread_width = 0.0;  // m
  int tread_vertices = 0;    // the first of them, without grousers; 0: all
};

class Tire {
 public:
  virtual ~Tire() = default;

  const SurfaceMesh& mesh() const { return shape_.mesh; }
  ContactMaterial material() const { return shape_.material; }
  MassProperties mass_properties() const { return shape_.mass; }
  double radius() const { return shape_.radius; }            // of the undeformed contact surface, m
  double tread_width() const { return shape_.tread_width; }  // m
  /// How many of the first vertices are of the wheel beneath its grousers.
  int tread_vertices() const { return shape_.tread_vertices > 0 ? shape_.tread_vertices : shape_.mesh.vertex_count; }
  Vec3 gravity() const { return gravity_; }  // W, m/s²
  virtual int coordinates() const = 0;       // unknowns

  /// Gauge pressure from now on, Pa. Ignored by tires without air.
  virtual void set_pressure(double) {}

  /// Puts the tire on the rim, inflated, with the velocity field of a rigid body moving with the rim.
  /// @throws Error(physics) when inflation does not converge.
  void place(const RimState& rim);

  /// Vertices at the current time.
  virtual void surface(SurfaceState& out) const = 0;
  /// Vertices on the given rim, for a tire that follows its rim (TireDescription::follows_rim).
  virtual void surface_on(const RimState& rim, SurfaceState& out) const;

  /// Largest principal strain of the contact surface at each vertex; empty for a model without.
  virtual std::vector<float> strain() const { return {}; }

  /// Computes the contact forces of a tire with a contact law of its own (TireDescription::own_contact). The interval
  /// begins with this rim and has the same `duration` as the one before.
  /// @returns failure when the tire left the model's range
  virtual Outcome state_contact(const RimState& /*rim*/, double /*duration*/) { return {}; }
  /// The forces of state_contact(), for the terrain to apply; null: the terrain computes them.
  virtual const StatedContact* stated_contact() const { return nullptr; }

  /// Integrates from the trajectory's start to its end in `substeps` equal steps, under gravity() and `forces`. Forces
  /// are constant. Those with tangents follow the motion if the model can (TireDescription::takes_tangents).
  /// @returns failure when the equations have no solution, a force or the rim's motion is not finite, or the tire left
  /// the model's range
  /// @pre placed or restored; substeps > 0; one force for each vertex, vertices of the mesh
  Outcome advance(const RimTrajectory& rim, const NodalForces& forces, int substeps);

  /// Force and moment about the rim centre that the tire exerts on the rim, averaged over the last advance. The tire's
  /// inertia and weight are included, so that impulse = Δ momentum holds to round-off for the whole tire.
  Wrench spindle_wrench() const { return spindle_; }

  /// Replaces the forces given to the last advance with the mean forces that acted. The two differ for forces with
  /// tangents.
  virtual void acted(NodalForces&) const {}

  /// @post every member is set and finite
  virtual TireDiagnostics diagnostics() const = 0;

  /// Cumulative counts of the model's method, and the quality of its last step: "newton_iterations", "factorizations",
  /// "residual", … Cheap enough for every step.
  virtual NamedValues figures() const { return {}; }
  /// Processor time of the parts of a step, s, cumulative; not part of the state.
  virtual NamedValues times() const { return {}; }
  /// Adds coordinates and velocities to a digest.
  virtual void add_state(Hash& hash) const = 0;

  /// State of the model and its integrator; a restored tire continues bit for bit.
  virtual void save(Archive& archive) const = 0;
  void restore(const Archive& archive);

 protected:
  /// A model that makes its shape itself sets it in its constructor.
  explicit Tire(const Vec3& gravity, TireShape shape = {}) : shape_(std::move(shape)), gravity_(gravity) {}

  /// Whether the tire was placed or restored.
  bool placed() const { return placed_; }

  TireShape shape_;
  Vec3 gravity_;    // m/s²
  RimState rim_;    // now
  Wrench spindle_;  // of the last advance

 private:
  virtual void do_place(const RimState& rim) = 0;
  /// Advances; advance() has checked the arguments.
  virtual Outcome do_advance(const RimTrajectory& rim, const NodalForces& forces, int substeps) = 0;
  virtual void do_restore(const Archive& archive) = 0;

  bool placed_ = false;
};

}  // namespace furrow::tire
