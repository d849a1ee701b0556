// Sums over all grains: the accounts, and the mean contact force that determines sleep.
#include <algorithm>

#include "protocol/core/assert.hpp"
#include "terrain/dem/accounts/stored_energy.hpp"
#include "terrain/dem/contact/size_scale.hpp"
#include "terrain/dem/grain_solver.hpp"

namespace furrow::terrain::dem {
double GrainSolver::relative_mass() const {
  double sum = 0.0;
  for (int g = 0; g < grains_.count; ++g) sum += cube(grains_.position[g].w / params_.grain.radius);
  return sum;
}

void GrainSolver::reset_accounts() {
  const Accounts old = accounts_;
  accounts_ = {};
  accounts_.elastic = accounts_.elastic_start = old.elastic;
  accounts_.floor_force = old.floor_force;
  accounts_.contacts = old.contacts;
  accounts_.contact_force = old.contact_force;
  accounts_.net_force = old.net_force;
  double rotation = 0.0;
  for (int g = 0; g < grains_.count; ++g) {
    const Quad &v = grains_.velocity[g], &w = grains_.spin[g];
    const double size = grains_.position[g].w / params_.grain.radius, mass = cube(size);
    accounts_.kinetic += mass * (0.5 * params_.grain.mass * (v.x * v.x + v.y * v.y + v.z * v.z) +
                                 0.5 * params_.grain.inertia * size * size * (w.x * w.x + w.y * w.y + w.z * w.z));
    rotation += mass * 0.5 * params_.grain.inertia * size * size * (w.x * w.x + w.y * w.y + w.z * w.z);
    const Quad& x = grains_.position[g];
    accounts_.height += mass * up_.dot(Vec3(x.x, x.y, x.z));
    accounts_.velocity += mass * Vec3(v.x, v.y, v.z);
  }
  for (int k = 0; k < strips_.count(); ++k) accounts_.active += grains_awake(strips_[k]);
  strips_.set_resorted(0);
  relative_mass_ = relative_mass();
  energies_.begin(stored_energy(grains_, strips_, params_.law, coefficients_, params_.grain.radius), rotation);
}

TerrainEnergies GrainSolver::reported_energies() const {
  const Losses lost = energies_.lost();
  const EnergyAccounts::State& sampled = energies_.state();
  TerrainEnergies e;
  e.kinetic = accounts_.kinetic - sampled.rotation;
  e.rotational = sampled.rotation;
  e.potential = params_.grain.mass * params_.gravity.norm() * accounts_.height;
  e.elastic_normal = accounts_.elastic - sampled.stored.cohesion;
  e.elastic_tangential = sampled.stored.tangential;
  e.cohesion = sampled.stored.cohesion;
  e.sliding_loss = lost.sliding;
  e.normal_damping_loss = lost.normal_damping;
  e.tangential_damping_loss = lost.tangential_damping;
  e.rolling_loss = lost.rolling;
  e.opening_loss = lost.opening;
  e.sleep_loss = accounts_.slept;
  e.sample_error = energies_.error();
  return e;
}

std::int32_t GrainSolver::grains_awake(const Strip& strip) const {
  if (strip.asleep) return 0;
  std::int32_t awake = strip.grains();
  for (const Parcel& parcel : strip.parcels)
    if (parcel.asleep) awake -= parcel.part.grains();
  return awake;
}

double GrainSolver::measured_force(int k) const {
  if (activity_.evaluated(k)) return strips_[k].contact.contact_force;
  return in_range(k, samples_.size()) ? samples_[k].force : 0.0;
}

void GrainSolver::take_samples() {
  samples_.resize(strips_.count());
  double force = 0.0;
  std::int64_t contacts = 0;
  for (int k = 0; k < strips_.count(); ++k) {
    const ContactTotals& now = strips_[k].contact;
    if (activity_.evaluated(k)) samples_[k] = {now.contact_force, now.contacts};
    force += samples_[k].force;
    contacts += samples_[k].contacts;
  }
  if (contacts > 0) mean_contact_force_ = force / static_cast<double>(contacts);
  until_sample_ = kSampleSteps;
}

void GrainSolver::reduce(const StepPart& part, Wanted wanted) {
  const double dt = part.kick();
  Accounts& a = accounts_;
  double power = 0.0, work = 0.0, contact_force = 0.0, net_force = 0.0, spin2 = 0.0;
  Quad wall, held;
  a.elastic = a.floor_force = a.kinetic = a.height = 0.0;
  a.velocity.setZero();
  a.contacts = a.active = 0;
  for (int k = 0; k < strips_.count(); ++k) {
    const ContactTotals& c = strips_[k].contact;
    const MotionTotals& m = strips_[k].motion;
    power += c.power;
    work += m.step_work;
    if (wanted.forces) contact_force += measured_force(k);
    net_force += m.net_force;
    add(wall, load(c.wall_force));
    a.elastic += c.elastic;
    a.floor_force += c.floor_force;
    a.kinetic += m.kinetic;
    spin2 += m.spin2;
    a.height += m.height;
    a.velocity += Vec3(m.velocity.x, m.velocity.y, m.velocity.z);
    a.contacts += c.contacts;
    a.max_overlap = std::max(a.max_overlap, c.max_overlap);
    a.active += grains_awake(strips_[k]);
    if (strips_[k].asleep) {
      add(held, load(m.held));
    } else if (strips_[k].parcels.size() > 1) {
      for (const Parcel& parcel : strips_[k].parcels)
        if (parcel.asleep) add(held, load(parcel.motion.held));
    }
  }
  // Forces of the step act on velocities that change during it: Σ F·v at mid-step = Σ F·v + ½ dt Σ (F·a + T·α).
  a.contact_work += dt * (power + 0.5 * dt * work);
  a.wall_impulse += dt * Vec3(wall.x, wall.y, wall.z);
  a.momentum_removed += dt * Vec3(held.x, held.y, held.z);
  if (wanted.losses)
    energies_.sample(strips_.count(),
                     [&](int k) { return activity_.evaluated(k) ? &strips_[k].contact.sample : nullptr; });
  energies_.advance(dt, part.last, 0.5 * params_.grain.inertia * spin2);
  if (wanted.forces) {
    a.contact_force = contact_force;
    a.net_force = net_force;
  }
}

}  // namespace furrow::terrain::dem
