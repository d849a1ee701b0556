// Contacts of grains with the bin: arm r − δ, the wall at rest.
#pragma once

#include <algorithm>

#include "protocol/core/assert.hpp"
#include "terrain/dem/contact/kinematics.hpp"
#include "terrain/dem/contact/laws.hpp"
#include "terrain/dem/strips.hpp"

namespace furrow::terrain::dem {

/// Coefficients per partner for grains of the reference radius; they depend on the step through the impulse limit.
struct SolverCoefficients {
  ContactCoefficients pair, floor, side;
};

/// Adds the forces of the strip's wall contacts [from, to) to `loads` (which starts at its first grain) and to `sums`.
/// radius: that of the coefficients; without kSizes that of all grains, m. @pre radius > 0, dt > 0
template <class Law, bool kRolling, bool kSizes>
void wall_forces(const Grains& grains, Strip& strip, int from, int to, const Bin& bin, double radius,
                 const SolverCoefficients& all, double dt, Wanted wanted, const Loads& loads, ContactTotals& sums) {
  FURROW_ASSERT(radius > 0.0 && dt > 0.0, radius, dt);
  FURROW_ASSERT(0 <= from && from <= to && static_cast<std::size_t>(to) <= strip.walls.size(), from, to,
                strip.walls.size());
  using Coefficients = typename Law::template Coefficients<double>;
  const Coefficients floor = all.floor.of<Law>(), side = all.side.of<Law>();
  const auto coefficients = [&](const WallContact& contact) {
    const Coefficients& c = contact.wall == kFloor ? floor : side;
    return kSizes ? sized_surface<Law>(c, radius, grains.position[strip.first + contact.grain].w, 0.0) : c;
  };
  for (int n = from; n < to; ++n) {
    WallContact& contact = strip.walls[n];
    FURROW_ASSERT(in_range(contact.grain, strip.grains()), contact.grain, strip.grains());
    FURROW_ASSERT(in_range(contact.wall, kWalls), contact.wall);
    const int g = strip.first + contact.grain;
    const double distance = bin.distance(contact.wall, grains.position[g]);
    const double overlap = (kSizes ? grains.position[g].w : radius) - distance;
    Quad &t = contact.tangential, &r = contact.rolling;
    ContactHistory<double> history{{t.x, t.y, t.z}, t.w, {r.x, r.y, r.z}};
    if (!(overlap > 0.0)) {
      if (wanted.losses) sums.sample.power.opening += Law::held(coefficients(contact), 0.0, history).tangential / dt;
      t = r = {};
      continue;
    }
    if (distance < 0.0) strip.lost = contact.grain;
    const Quad &v = grains.velocity[g], &w = grains.spin[g];
    const WallPoint<double> at =
        point_on_wall(Bin::normal(contact.wall), distance, overlap, {v.x, v.y, v.z}, {w.x, w.y, w.z});
    const ContactMotion<double>& motion = at.motion;
    const Coefficients c = coefficients(contact);
    if (wanted.losses) add(sums.sample, sample_of<Law, kRolling>(c, dt, motion, history));
    const ContactForce<double> f = Law::template force<kRolling>(c, dt, motion, history);
    if constexpr (Law::kHistory) {
      t = {history.tangential.x, history.tangential.y, history.tangential.z, history.root_overlap};
      if constexpr (kRolling) r = {history.rolling.x, history.rolling.y, history.rolling.z, 0.0};
    }
    const auto [force, torque] = wall_loads(f, at);
    const Double4 push{force.x, force.y, force.z, 0.0};
    add(loads.force[contact.grain], push);
    add(loads.torque[contact.grain], Double4{torque.x, torque.y, torque.z, 0.0});

    sums.power += power_of(f, motion) + dot(f.rolling, motion.roll);
    sums.elastic += f.energy;
    sums.max_overlap = std::max(sums.max_overlap, motion.overlap);
    add(sums.wall_force, push);
    if (contact.wall == kFloor) sums.floor_force += force.z;
    if (wanted.forces) sums.contact_force += std::sqrt(dot(force, force));
    ++sums.contacts;
  }
}

}  // namespace furrow::terrain::dem
