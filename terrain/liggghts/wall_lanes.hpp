// Contacts of grains with walls, four at a time: those of grains of the reference radius that touch no tire, in steps
// whose losses are not wanted. They are most of what a rank has beside its pairs.
#pragma once

#include <array>
#include <vector>

#include "protocol/core/assert.hpp"
#include "terrain/dem/bin.hpp"
#include "terrain/dem/contact_law.hpp"
#include "terrain/dem/contact_mixing.hpp"
#include "terrain/dem/parcel.hpp"
#include "terrain/liggghts/engine.hpp"

namespace furrow::terrain::liggghts {

/// Up to four contacts that wait for their evaluation, all with walls of the same coefficients.
struct WallLanes {
  static constexpr int kLanes = 4;
  int count = 0;
  std::array<int, kLanes> grain{}, wall{};
  std::array<int, kLanes> entry{};  // of its history among what the grain carries
  dem::Double4 distance{};          // of the centre from the wall, m
};

/// The walls that a grain at `at` touches, a bit for each, and how far its centre is from each, m.
inline unsigned walls_touched(const dem::Bin& bin, const dem::Quad& at,
                              std::array<double, dem::kWalls>& distance) {
  unsigned touched = 0;
  for (int wall = 0; wall < dem::kWalls; ++wall) {
    distance[wall] = bin.distance(wall, at);
    if (bin.has_wall(wall) && at.w - distance[wall] > 0.0) touched |= 1U << wall;
  }
  return touched;
}

/// Leaves a grain the histories of the walls that it touches, and gives it those that it lacks.
inline void keep_touched(CarriedList& carried, unsigned touched) {
  unsigned known = 0;
  bool others = false;
  for (const Carried& c : carried)
    known |= c.partner < dem::kWalls ? 1U << static_cast<int>(c.partner) : 0U,
        others |= c.partner >= dem::kWalls;
  if (known == touched && !others) return;
  std::erase_if(carried, [touched](const Carried& c) {
    return c.partner >= dem::kWalls || !(touched >> static_cast<int>(c.partner) & 1U);
  });
  for (int wall = 0; wall < dem::kWalls; ++wall) {
    if (!((touched & ~known) >> wall & 1U)) continue;
    Carried c;
    c.partner = wall;
    const dem::Triple<double> n = dem::Bin::normal(wall);
    c.normal = {n.x, n.y, n.z};
    carried.push_back(c);
  }
}

/// Adds the forces of the waiting contacts to the grains and to `sums`; none waits any longer. Calls
/// note(overlap, grain) for each. @pre radius > 0 of all grains, m; dt > 0, s
template <class Law, bool kRolling, class Note>
void wall_forces(WallLanes& lanes, const OwnGrains& grains, const dem::ContactCoefficients& c, double radius,
                 double dt, dem::ContactTotals& sums, const Note& note) {
  using dem::Double4;
  using dem::Triple;
  constexpr int kLanes = WallLanes::kLanes;
  FURROW_ASSERT(radius > 0.0 && dt > 0.0, radius, dt);
  if (lanes.count == 0) return;
  // Lanes that nobody waits in evaluate the first contact once more.
  for (int k = lanes.count; k < kLanes; ++k) {
    lanes.grain[k] = lanes.grain[0], lanes.wall[k] = lanes.wall[0], lanes.entry[k] = lanes.entry[0];
    lanes.distance[k] = lanes.distance[0];
  }
  Triple<Double4> normal, velocity, spin, tangential, rolling{};
  Double4 root_before;
  for (int k = 0; k < kLanes; ++k) {
    const int g = lanes.grain[k];
    const double *const v = grains.velocity[g], *const w = grains.spin[g];
    const Carried& history = grains.carried[g][lanes.entry[k]];
    const Triple<double> n = dem::Bin::normal(lanes.wall[k]);
    normal.x[k] = n.x, normal.y[k] = n.y, normal.z[k] = n.z;
    velocity.x[k] = v[0], velocity.y[k] = v[1], velocity.z[k] = v[2];
    spin.x[k] = w[0], spin.y[k] = w[1], spin.z[k] = w[2];
    tangential.x[k] = history.tangential[0], tangential.y[k] = history.tangential[1];
    tangential.z[k] = history.tangential[2];
    root_before[k] = history.root_overlap;
    if constexpr (kRolling)
      rolling.x[k] = history.rolling[0], rolling.y[k] = history.rolling[1], rolling.z[k] = history.rolling[2];
  }
  dem::ContactMotion<Double4> motion;
  motion.normal = normal;
  motion.roll = spin;
  const Triple<Double4> arm = (-lanes.distance) * normal;
  motion.overlap = radius - lanes.distance;
  motion.root_overlap = dem::root(motion.overlap);
  motion.velocity = velocity + cross(spin, arm);
  motion.spin = 0.5 * dot(spin, normal);
  dem::ContactHistory<Double4> history{tangential, root_before, rolling};
  const dem::ContactForce<Double4> f = Law::template force<kRolling>(c, dt, motion, history);
  const Triple<Double4> force = f.normal * normal + f.tangential;
  const Triple<Double4> torque = cross(arm, f.tangential) + f.rolling;
  for (int k = 0; k < lanes.count; ++k) {
    const int g = lanes.grain[k];
    double *const on = grains.force[g], *const turns = grains.torque[g];
    on[0] += force.x[k], on[1] += force.y[k], on[2] += force.z[k];
    turns[0] += torque.x[k], turns[1] += torque.y[k], turns[2] += torque.z[k];
    if constexpr (Law::kHistory) {
      Carried& to = grains.carried[g][lanes.entry[k]];
      to.tangential = {history.tangential.x[k], history.tangential.y[k], history.tangential.z[k]};
      to.root_overlap = history.root_overlap[k];
      if constexpr (kRolling) to.rolling = {history.rolling.x[k], history.rolling.y[k], history.rolling.z[k]};
    }
    sums.elastic += f.energy[k];
    dem::add(sums.wall_force, Double4{force.x[k], force.y[k], force.z[k], 0.0});
    if (lanes.wall[k] == dem::kFloor) sums.floor_force += force.z[k];
    ++sums.contacts;
    note(motion.overlap[k], g);
  }
  lanes.count = 0;
}

}  // namespace furrow::terrain::liggghts
