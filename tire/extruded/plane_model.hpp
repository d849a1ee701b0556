// A tire in the plane of its wheel, on a rim with a given motion: the part of an extruded tire (extruded_tire.hpp) that
// moves in its plane. Positions and velocities of nodes are relative to the rim's centre, in axes that do not turn with
// the rim. Angles are about +y: forward rolling increases them.
#pragma once

#include <vector>

#include "protocol/core/archive.hpp"
#include "protocol/core/outcome.hpp"
#include "tire/extruded/plane_contact.hpp"
#include "tire/extruded/plane_vectors.hpp"
#include "tire/named_values.hpp"

namespace furrow::tire {

/// Motion of the rim's centre in a step, and angle of the rim at its end.
struct PlaneRimStep {
  PlanarPoint velocity;  // of the centre: displacement over the step's time, m/s
  double angle = 0.0;    // rad
};

/// Sums over steps.
struct PlaneSums {
  double impulse_x = 0.0, impulse_z = 0.0;  // of the tire on the rim, N s
  double turn_impulse = 0.0;                // about +y, N m s
  double rim_work = 0.0;                    // of the rim on the tire, J
  double contact_work = 0.0;                // of the ground on the tire in its plane, by a PlaneContact, J
  double dissipation = 0.0;                 // by viscosity, J
  double numerical_loss = 0.0;              // J
  double solver_loss = 0.0;                 // J
  PlanarPoint solver_impulse;               // part of the impulse, N s
};

class PlaneModel {
 public:
  virtual ~PlaneModel() = default;

  virtual int coordinates() const = 0;
  /// Nodes of the outer edge in the order of the pairs of vertices of cylinder(): from the top of the rim forwards.
  virtual const std::vector<int>& tread() const = 0;
  virtual double tread_mass() const = 0;  // of these nodes, kg

  /// Gauge pressure from now on, Pa.
  virtual void set_pressure(double pressure) = 0;
  /// Places the tire undeformed, moving as a rigid body with the rim. @param spin rad/s
  virtual void place(double angle, double spin, PlanarPoint velocity) = 0;
  /// Sets `count` to the number of equal steps that a step of h is divided into. @returns failure when they are too
  /// many
  virtual Outcome parts(double h, int& count) = 0;
  /// The contact of a tire that computes it in its steps; null: the tire is given its forces.
  virtual PlaneContact* contact() { return nullptr; }
  /// One step of h. @param load on nodes, N. @param gravity in the wheel's plane, m/s²
  /// @pre placed or restored; h > 0; contact() is placed where the rim is at the step's start
  virtual Outcome step(double h, const PlaneRimStep& rim, const PlanarField& load, PlanarPoint gravity,
                       PlaneSums& sums) = 0;
  /// Checks that the tire is in the model's range.
  virtual Outcome check() const = 0;

  virtual const PlanarField& position() const = 0;  // m
  virtual const PlanarField& velocity() const = 0;  // m/s
  virtual PlanarPoint centre_velocity() const = 0;  // of the last step, m/s
  virtual PlanarPoint first_moment() const = 0;     // Σ m r, kg m
  virtual PlanarPoint momentum() const = 0;         // kg m/s
  virtual double angular_momentum() const = 0;      // about the rim's centre, kg m²/s
  virtual double kinetic_energy() const = 0;        // J
  virtual double elastic_energy() const = 0;        // J
  virtual double pressure_energy() const = 0;       // J

  virtual NamedValues figures() const = 0;
  virtual void save(Archive& archive) const = 0;
  virtual void restore(const Archive& archive) = 0;
};

}  // namespace furrow::tire
