// Explicit integration of planar triangles and their loads.
//
// Semi-implicit Euler: v += (F/m) h, then x += v h. It keeps linear and angular momentum to round-off. The Runge–Kutta
// method of fourth order needs four times the work.
#pragma once

#include <functional>

#include "tire/planar/planar_params.hpp"
#include "tire/planar/rubbing_contact.hpp"

namespace furrow::tire {

class PlanarMotion {
 public:
  /// Adds the external loads on nodes to a force. @param step s, by which contact limits its force
  using Loads = std::function<void(const PlanarState& state, double step, PlanarField& force)>;

  PlanarMotion(PlanarElements elements, PlanarState start,
               PlanarIntegrator integrator = PlanarIntegrator::semi_implicit_euler);

  void set_loads(Loads loads) { loads_ = std::move(loads); }
  /// Adds mass to a node, kg.
  void add_mass(int node, double mass) { mass_[node] += mass; }
  /// Keeps a node's velocity in these directions at the value of set_velocity().
  void hold(int node, bool x, bool z);
  void set_velocity(int node, double x, double z) { state_.v.x[node] = x, state_.v.z[node] = z; }

  /// One step of h, s. @returns whether no triangle was turned inside out
  bool step(double h);

  const PlanarState& state() const { return state_; }
  const PlanarElements& elements() const { return elements_; }
  const std::vector<double>& mass() const { return mass_; }  // kg, with added masses
  /// Sum of the forces on nodes in the last step (in the first stage of a Runge–Kutta step), N. On a held node, the
  /// holder resists this force.
  const PlanarField& force() const { return force_; }
  double kinetic_energy() const;  // J

 private:
  bool accelerate(const PlanarState& at, double h, PlanarField& force, PlanarField& rate);
  bool euler(double h);
  bool runge_kutta(double h);

  PlanarElements elements_;
  PlanarIntegrator integrator_;
  Loads loads_;
  PlanarState state_;
  std::vector<double> mass_;
  struct Held {
    int node;
    bool x, z;
  };
  std::vector<Held> held_;
  PlanarField force_, rate_;
  PlanarState stage_, sum_;  // of Runge–Kutta
  PlanarField stage_force_;
};

}  // namespace furrow::tire
