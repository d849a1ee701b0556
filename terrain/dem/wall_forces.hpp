// Grains against the bin: arm r − δ, the wall at rest.
#pragma once

#include <algorithm>

#include "protocol/core/assert.hpp"
#include "terrain/dem/contact_law.hpp"
#include "terrain/dem/contact_mixing.hpp"
#include "terrain/dem/size_scale.hpp"
#include "terrain/dem/strips.hpp"

namespace furrow::terrain::dem {

/// Coefficients per partner, for grains of the reference radius; they hold the step of the impulse limit.
struct SolverCoefficients {
  ContactCoefficients pair, floor, side;
};

/// Adds the forces of the strip's wall contacts [from, to) to `loads` (which starts at its first grain) and to `sums`.
/// radius: that the coefficients are for; without kSizes that of all grains, m. @pre radius > 0, dt > 0
template <class Law, bool kRolling, bool kSizes>
void wall_forces(const Grains& grains, Strip& strip, int from, int to, const Bin& bin, double radius,
                 const SolverCoefficients& all, double dt, Wanted wanted, const Loads& loads, ContactTotals& sums) {
  FURROW_ASSERT(radius > 0.0 && dt > 0.0, radius, dt);
  FURROW_ASSERT(0 <= from && from <= to && static_cast<std::size_t>(to) <= strip.walls.size(), from, to,
                strip.walls.size());
  const auto coefficients = [&](const WallContact& contact) {
    ContactCoefficients c = contact.wall == kFloor ? all.floor : all.side;
    if constexpr (kSizes) c = scaled(c, surface_scale(grains.position[strip.first + contact.grain].w / radius, 0.0));
    return c;
  };
  const auto held = [&](const WallContact& contact, const ContactCoefficients& c) {
    const Quad &t = contact.tangential, &r = contact.rolling;
    return held_by_springs(c, {t.x, t.y, t.z}, t.w, {r.x, r.y, r.z});
  };
  for (int n = from; n < to; ++n) {
    WallContact& contact = strip.walls[n];
    FURROW_ASSERT(in_range(contact.grain, strip.grains()), contact.grain, strip.grains());
    FURROW_ASSERT(in_range(contact.wall, kWalls), contact.wall);
    const int g = strip.first + contact.grain;
    const double distance = bin.distance(contact.wall, grains.position[g]);
    ContactMotion<double> motion;
    motion.overlap = (kSizes ? grains.position[g].w : radius) - distance;
    if (!(motion.overlap > 0.0)) {
      if (wanted.losses) sums.sample.power.opening += held(contact, coefficients(contact)) / dt;
      contact.tangential = contact.rolling = {};
      continue;
    }
    if (distance < 0.0) strip.lost = contact.grain;
    const Quad &v = grains.velocity[g], &w = grains.spin[g];
    motion.normal = Bin::normal(contact.wall);
    motion.roll = {w.x, w.y, w.z};
    const Triple<double> arm = -distance * motion.normal;
    motion.root_overlap = std::sqrt(motion.overlap);
    motion.velocity = Triple<double>{v.x, v.y, v.z} + cross(motion.roll, arm);
    motion.spin = 0.5 * dot(motion.roll, motion.normal);
    Quad &t = contact.tangential, &r = contact.rolling;
    ContactHistory<double> history{{t.x, t.y, t.z}, t.w, {r.x, r.y, r.z}};
    const ContactCoefficients c = coefficients(contact);
    if (wanted.losses) add(sums.sample, sample_of<Law, kRolling>(c, dt, motion, history));
    const ContactForce<double> f = Law::template force<kRolling>(c, dt, motion, history);
    if constexpr (Law::kHistory) {
      t = {history.tangential.x, history.tangential.y, history.tangential.z, history.root_overlap};
      if constexpr (kRolling) r = {history.rolling.x, history.rolling.y, history.rolling.z, 0.0};
    }
    const Triple<double> force = f.normal * motion.normal + f.tangential;
    const Triple<double> torque = cross(arm, f.tangential) + f.rolling;
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
