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

/// Up to four wall contacts with the same coefficients, in the order of the strip's walls. Lanes beyond the last repeat
/// it.
struct WallBatch {
  int count = 0;
  int contact[4] = {};  // of the strip's walls
  Double4 distance{};   // m
};

/// The contact law on wall contacts of a strip, four at a time. `loads` starts at the strip's first grain.
template <class Law, bool kRolling, bool kSizes>
class WallForces {
 public:
  using Coefficients = typename Law::template Coefficients<double>;

  WallForces(const Grains& grains, Strip& strip, double radius, double dt, Wanted wanted, const Loads& loads,
             ContactTotals& sums)
      : grains_(grains), strip_(strip), radius_(radius), dt_(dt), wanted_(wanted), loads_(loads), sums_(sums) {}

  /// Adds the forces of a contact that bears, once four of them or finish() complete its batch.
  void add_contact(int contact, double distance, const Coefficients& c) {
    batch_.contact[batch_.count] = contact;
    batch_.distance[batch_.count] = distance;
    if (++batch_.count == 4) finish(c);
  }

  /// @param c of the contacts since the last batch
  void finish(const Coefficients& c) {
    if (batch_.count == 0) return;
    for (int k = batch_.count; k < 4; ++k) {
      batch_.contact[k] = batch_.contact[batch_.count - 1];
      batch_.distance[k] = batch_.distance[batch_.count - 1];
    }
    run(c);
    batch_.count = 0;
  }

 private:
  WallContact& contact(int k) { return strip_.walls[batch_.contact[k]]; }

  /// x, y, z of the lanes' quads; the fourth number goes to `last`.
  template <class QuadOf>
  static Triple<Double4> lanes(const QuadOf& of, Double4& last) {
    Double4 row[4];
    for (int k = 0; k < 4; ++k) row[k] = of(k);
    transpose(row);
    last = row[3];
    return {row[0], row[1], row[2]};
  }

  void run(const Coefficients& reference) {
    const auto grain = [&](int k) { return strip_.first + contact(k).grain; };
    Double4 none, size = constant<Double4>(radius_);
    if constexpr (kSizes)
      for (int k = 0; k < 4; ++k) size[k] = grains_.position[grain(k)].w;
    const Triple<Double4> v = lanes([&](int k) { return load(grains_.velocity[grain(k)]); }, none);
    const Triple<Double4> w = lanes([&](int k) { return load(grains_.spin[grain(k)]); }, none);
    const Triple<Double4> normal = lanes([&](int k) { return load(Bin::normal_row(contact(k).wall)); }, none);
    const WallPoint<Double4> at = point_on_wall<Double4>(normal, batch_.distance, size - batch_.distance, v, w);
    ContactHistory<Double4> history{};
    if constexpr (Law::kHistory) {
      history.tangential = lanes([&](int k) { return load(contact(k).tangential); }, history.root_overlap);
      if constexpr (kRolling) history.rolling = lanes([&](int k) { return load(contact(k).rolling); }, none);
    }
    if (wanted_.losses) sample(reference, at.motion, history);
    const ContactForce<Double4> f = Law::template force<kRolling>(sized(reference, size), dt_, at.motion, history);
    if constexpr (Law::kHistory) {
      Double4 row[4] = {history.tangential.x, history.tangential.y, history.tangential.z, history.root_overlap};
      transpose(row);
      for (int k = 0; k < 4; ++k) store(contact(k).tangential, row[k]);
      if constexpr (kRolling) {
        Double4 turned[4] = {history.rolling.x, history.rolling.y, history.rolling.z, {}};
        transpose(turned);
        for (int k = 0; k < 4; ++k) store(contact(k).rolling, turned[k]);
      }
    }
    const auto [force, torque] = wall_loads(f, at);
    Double4 push[4] = {force.x, force.y, force.z, {}}, turn[4] = {torque.x, torque.y, torque.z, {}};
    transpose(push);
    transpose(turn);
    const Double4 power = power_of(f, at.motion) + dot(f.rolling, at.motion.roll);
    for (int k = 0; k < batch_.count; ++k) {
      const WallContact& one = contact(k);
      add(loads_.force[one.grain], push[k]);
      add(loads_.torque[one.grain], turn[k]);
      add(sums_.wall_force, push[k]);
      sums_.power += power[k];
      sums_.elastic += f.energy[k];
      sums_.max_overlap = std::max(sums_.max_overlap, at.motion.overlap[k]);
      if (one.wall == kFloor) sums_.floor_force += push[k][2];
      if (wanted_.forces)
        sums_.contact_force += std::sqrt(push[k][0] * push[k][0] + push[k][1] * push[k][1] + push[k][2] * push[k][2]);
    }
    sums_.contacts += batch_.count;
  }

  /// Coefficients of grains of these radii, m.
  auto sized(const Coefficients& reference, Double4 size) const {
    if constexpr (kSizes)
      return Law::scaled(reference, surface_scale<Double4>(size / radius_, 0.0));
    else
      return reference;
  }

  /// Adds the losses before the law updates its histories.
  [[gnu::noinline]] void sample(const Coefficients& reference, const ContactMotion<Double4>& motion,
                                const ContactHistory<Double4>& history) {
    const auto of = [](const Triple<Double4>& t, int k) { return Triple<double>{t.x[k], t.y[k], t.z[k]}; };
    for (int k = 0; k < batch_.count; ++k) {
      const double r = kSizes ? grains_.position[strip_.first + contact(k).grain].w : radius_;
      const ContactMotion<double> at{of(motion.normal, k),   motion.overlap[k], motion.root_overlap[k],
                                     of(motion.velocity, k), motion.spin[k],    of(motion.roll, k)};
      add(sums_.sample,
          sample_of<Law, kRolling>(sized_surface<Law>(reference, radius_, r, 0.0), dt_, at,
                                   {of(history.tangential, k), history.root_overlap[k], of(history.rolling, k)}));
    }
  }

  const Grains& grains_;
  Strip& strip_;
  double radius_, dt_;  // m, s
  Wanted wanted_;
  const Loads& loads_;
  ContactTotals& sums_;
  WallBatch batch_;
};

/// Adds the forces of the strip's wall contacts [from, to) to `loads` (which starts at its first grain) and to `sums`.
/// radius: that of the coefficients; without kSizes that of all grains, m. @pre radius > 0, dt > 0
template <class Law, bool kRolling, bool kSizes>
void wall_forces(const Grains& grains, Strip& strip, int from, int to, const Bin& bin, double radius,
                 const SolverCoefficients& all, double dt, Wanted wanted, const Loads& loads, ContactTotals& sums) {
  FURROW_ASSERT(radius > 0.0 && dt > 0.0, radius, dt);
  FURROW_ASSERT(0 <= from && from <= to && static_cast<std::size_t>(to) <= strip.walls.size(), from, to,
                strip.walls.size());
  const auto floor = all.floor.of<Law>(), side = all.side.of<Law>();
  WallForces<Law, kRolling, kSizes> forces(grains, strip, radius, dt, wanted, loads, sums);
  const bool alike = all.floor == all.side;
  const auto* last = &floor;  // of the batch
  for (int n = from; n < to; ++n) {
    WallContact& contact = strip.walls[n];
    FURROW_ASSERT(in_range(contact.grain, strip.grains()), contact.grain, strip.grains());
    FURROW_ASSERT(in_range(contact.wall, kWalls), contact.wall);
    const Quad& position = grains.position[strip.first + contact.grain];
    const double distance = bin.distance(contact.wall, position), r = kSizes ? position.w : radius;
    const auto& c = contact.wall == kFloor ? floor : side;
    if (r > distance) {
      if (distance < 0.0) strip.lost = contact.grain;
      if (!alike && last != &c) forces.finish(*last);
      last = &c;
      forces.add_contact(n, distance, c);
      continue;
    }
    Quad &t = contact.tangential, &rolling = contact.rolling;
    if (wanted.losses)
      sums.sample.power.opening += Law::held(sized_surface<Law>(c, radius, r, 0.0), 0.0,
                                             {{t.x, t.y, t.z}, t.w, {rolling.x, rolling.y, rolling.z}})
                                       .tangential /
                                   dt;
    t = rolling = {};
  }
  forces.finish(*last);
}

}  // namespace furrow::terrain::dem
