#include "terrain/liggghts/rank_states.hpp"

#include <cmath>

#include "protocol/core/assert.hpp"
#include "protocol/core/field_arithmetic.hpp"

namespace furrow::terrain::liggghts {
StateReport state_report(const RankContacts& contacts, double grains, double of_all, double list_builds) {
  FURROW_ASSERT(of_all > 0.0, of_all);
  StateReport r;
  r.grains = grains;
  r.sums = contacts.sums();
  r.lost = contacts.energies().lost();
  r.stored = contacts.energies().state().stored;
  r.error2 = contacts.energies().state().error2;
  r.list_builds = grains * list_builds / of_all;
  return r;
}

void add(StateReport& to, const StateReport& one) {
  to = sum_of(to, one);
  to.sums.gravity_time = one.sums.gravity_time;
}

TerrainState terrain_state(const StateReport& all, const dem::GrainProperties& grain, const Vec3& gravity,
                           double surface_work) {
  const MotionSums& motion = all.sums.motion;
  const double mass = grain.mass * motion.volume;
  TerrainState s;
  TerrainEnergies& e = s.energies;
  e.kinetic = 0.5 * grain.mass * motion.speed2;
  e.rotational = 0.5 * grain.inertia * motion.spin2;
  s.kinetic_energy = e.kinetic + e.rotational;
  s.elastic_energy = all.sums.elastic;
  s.floor_force = all.sums.floor_force;
  s.contacts = std::llround(all.sums.contacts);
  s.active = std::llround(all.grains);
  s.list_rebuilds = std::llround(all.list_builds);
  e.potential = -grain.mass * gravity.dot(motion.place);  // Σ m |g| h = −g·Σ m x with the positions x
  e.elastic_normal = all.sums.elastic - all.stored.cohesion;
  e.elastic_tangential = all.stored.tangential;
  e.cohesion = all.stored.cohesion;
  e.sliding_loss = all.lost.sliding;
  e.normal_damping_loss = all.lost.normal_damping;
  e.tangential_damping_loss = all.lost.tangential_damping;
  e.rolling_loss = all.lost.rolling;
  e.opening_loss = all.lost.opening;
  e.sample_error = std::sqrt(all.error2);
  e.surface_work = surface_work;
  const Vec3 weight = all.sums.gravity_time * mass * gravity;
  s.momenta = {grain.mass * motion.speed, weight, all.sums.wall_impulse, all.sums.surface_impulse, Vec3::Zero()};
  return s;
}

}  // namespace furrow::terrain::liggghts
