// A tire with an imposed rim motion, for the tests of whole tires.
#pragma once

#include <gtest/gtest.h>

#include <utility>

#include "protocol/core/mean_turn.hpp"
#include "tests/nodal_sums.hpp"
#include "tire/rim_trajectory.hpp"
#include "tire/tire.hpp"

namespace furrow::test {

template <class Tire>
struct Led {
  Tire tire;
  tire::RimTrajectory path;

  /// @param arguments of the tire's constructor
  template <class... Arguments>
  explicit Led(const RimState& start, Arguments&&... arguments)
      : tire(std::forward<Arguments>(arguments)...), path(start) {
    tire.place(start);
  }

  Outcome advance(const RimState& rim, double h, const NodalForces& forces = {}, int substeps = 1) {
    path.extend(rim, h);
    return tire.advance(path, forces, substeps);
  }
  void go(const RimState& rim, double h, const NodalForces& forces = {}, int substeps = 1) {
    const Outcome outcome = advance(rim, h, forces, substeps);
    ASSERT_TRUE(outcome.ok) << outcome.message("tire");
  }
  /// Runs intervals without moving the rim.
  void hold(int steps, double h, const NodalForces& forces = {}) {
    for (int n = 0; n < steps; ++n) go(path.end(), h, forces);
  }
  SurfaceState surface() const {
    SurfaceState state;
    tire.surface(state);
    return state;
  }
};

/// Work of the rim on a tire over the last interval, J.
inline double rim_work(const tire::Tire& tire, const tire::RimTrajectory& path) {
  const Wrench w = tire.spindle_wrench();
  return -(w.force.dot(path.end().position - path.start().position) +
           w.moment.dot(mean_turn(path.start().orientation, path.end().orientation)));
}
/// Work of forces on the surface over an interval, from its state before and after, J.
inline double surface_work(const NodalForces& f, const SurfaceState& before, const SurfaceState& after) {
  double work = 0.0;
  for (std::size_t k = 0; k < f.vertex.size(); ++k)
    work += f.force[k].dot(after.position[f.vertex[k]] - before.position[f.vertex[k]]);
  return work;
}

}  // namespace furrow::test
