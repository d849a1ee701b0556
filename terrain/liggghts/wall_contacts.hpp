// The contacts of one rank's grains with the walls of the bin. Who may touch which wall is listed when the lists of
// pairs are made; the histories lie beside that list, wall by wall, so that four contacts are
// evaluated at a time and nothing is looked for. Before grains change their numbers the histories go to the grains,
// which carry them from rank to rank (engine.hpp).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "protocol/core/assert.hpp"
#include "terrain/dem/bin.hpp"
#include "terrain/dem/contact_law.hpp"
#include "terrain/dem/contact_mixing.hpp"
#include "terrain/dem/parcel.hpp"
#include "terrain/dem/size_scale.hpp"
#include "terrain/dem/wall_forces.hpp"
#include "terrain/liggghts/engine.hpp"

namespace furrow::terrain::liggghts {

class WallContacts {
 public:
  /// What some contacts showed.
  struct Findings {
    int lost = -1;         // a grain whose centre is not within the walls
    int hardest = -1;      // a grain of the contact whose share is the largest
    double share = 0.0;    // its overlap over the diameter, -
    double overlap = 0.0;  // largest, m
  };
  struct Step {
    const dem::SolverCoefficients& coefficients;
    double dt;    // s
    bool losses;  // are sampled
    bool sizes;   // radii differ
  };

  /// @param reference  the radius that coefficients are for, m  @pre reference > 0
  WallContacts(const dem::Bin& bin, double reference) : bin_(bin), reference_(reference) {
    FURROW_ASSERT(reference > 0.0, reference);
  }

  /// Lists, in this order, the grains that stand within `room` of touching a wall, m. Takes over what they carry of
  /// walls.
  /// @returns a grain whose centre is not within the walls
  std::optional<int> list(const OwnGrains& grains, std::span<const std::int32_t> order, double room);
  /// What is remembered goes to the grains; list() takes it back. Their numbers may change meanwhile.
  void hand_back(const OwnGrains& grains);
  /// The grains are other ones: nothing is remembered.
  void forget();
  /// What is remembered, wall by wall: see(grain, history).
  template <class See>
  void for_touching(const See& see) const {
    for (int wall = 0; wall < dem::kWalls; ++wall)
      for (std::size_t n = 0; n < walls_[wall].count; ++n)
        if (walls_[wall].root[n] > 0.0) see(walls_[wall].grain[n], walls_[wall].carried(wall, n));
  }

  /// Adds what walls do to the grains before place `last` of that order that were not asked for since begin().
  /// @pre radii of listed grains are `reference` unless step.sizes; step.dt > 0
  template <class Law, bool kRolling>
  void add_forces(const OwnGrains& grains, int last, const Step& step, dem::ContactTotals& sums, Findings& found);
  void begin() { next_ = {}; }

 private:
  static constexpr std::size_t kLanes = simd::kDoubleLanes;

  /// The grains that may touch one wall, and what they remember of it. Arrays have room for kLanes more.
  struct Listed {
    std::size_t count = 0;
    std::vector<int> grain, place;                           // in OwnGrains, in the order
    std::array<std::vector<double>, 3> tangential, rolling;  // springs on the grain, N, N m
    std::vector<double> root;                                // √δ of the step before, √m; 0: apart

    void clear();
    void add(int g, int at);
    void make_room();
    void copy(std::size_t to, const Listed& from, std::size_t n);
    Carried carried(int wall, std::size_t n) const;
    simd::Triple<simd::Double4> vector(const std::array<std::vector<double>, 3>& of, std::size_t n) const {
      return {simd::load(&of[0][n]), simd::load(&of[1][n]), simd::load(&of[2][n])};
    }
    void take(std::size_t n, const Carried& c);
  };
  using Grains = OwnGrains;
  using Four = simd::Double4;
  using Vector = simd::Triple<Four>;

  template <class Law, bool kRolling>
  void evaluate_four(const Grains& grains, int wall, std::size_t n, std::size_t count, const Step& step,
                     dem::ContactTotals& sums, Findings& found);
  template <class Law, bool kRolling>
  void evaluate_one(const Grains& grains, int wall, std::size_t n, const Step& step, dem::ContactTotals& sums,
                    Findings& found);
  void remember();
  void take_carried(const OwnGrains& grains);
  const dem::ContactCoefficients& of(int wall, const Step& step) const {
    return wall == dem::kFloor ? step.coefficients.floor : step.coefficients.side;
  }
  /// As Bin::distance.
  Four distances(int wall, const Vector& x) const {
    switch (wall) {
      case 0:
        return x.x;
      case 1:
        return bin_.length - x.x;
      case 2:
        return x.y + 0.5 * bin_.width;
      case 3:
        return 0.5 * bin_.width - x.y;
      default:
        return x.z;
    }
  }
  dem::Quad at(const Grains& grains, int g) const {
    const double* const x = grains.position[g];
    return {x[0], x[1], x[2], grains.radius[g]};
  }

  dem::Bin bin_;
  double reference_;  // m
  std::array<Listed, dem::kWalls> walls_, before_;
  std::array<std::size_t, dem::kWalls> next_{};  // of each wall, in this step
  bool numbered_ = false;                        // the numbers in walls_ are those of the grains now
  std::vector<int> before_at_;                   // of each grain, its place among those before; -1: none
};

template <class Law, bool kRolling>
void WallContacts::add_forces(const OwnGrains& grains, int last, const Step& step, dem::ContactTotals& sums,
                              Findings& found) {
  FURROW_ASSERT(step.dt > 0.0, step.dt);
  for (int wall = 0; wall < dem::kWalls; ++wall) {
    const Listed& listed = walls_[wall];
    std::size_t& next = next_[wall];
    std::size_t end = next;
    while (end < listed.count && listed.place[end] < last) ++end;
    if (step.losses || step.sizes) {
      for (; next < end; ++next) evaluate_one<Law, kRolling>(grains, wall, next, step, sums, found);
      continue;
    }
    for (; next < end; next += std::min(kLanes, end - next))
      evaluate_four<Law, kRolling>(grains, wall, next, std::min(kLanes, end - next), step, sums, found);
  }
}

/// The first `count` of four contacts from n on; the others are evaluated too, as grains that do not touch.
template <class Law, bool kRolling>
void WallContacts::evaluate_four(const Grains& grains, int wall, std::size_t n, std::size_t count, const Step& step,
                                 dem::ContactTotals& sums, Findings& found) {
  Listed& listed = walls_[wall];
  const int* const g = listed.grain.data() + n;
  const auto gather = [g](const double(*from)[3], int axis) {
    return Four{from[g[0]][axis], from[g[1]][axis], from[g[2]][axis], from[g[3]][axis]};
  };
  const simd::Triple<double> n_of = dem::Bin::normal(wall);
  const Vector normal{simd::spread(n_of.x), simd::spread(n_of.y), simd::spread(n_of.z)};
  const Vector x{gather(grains.position, 0), gather(grains.position, 1), gather(grains.position, 2)};
  const Four distance = distances(wall, x);
  const Four overlap = reference_ - distance;
  const Four none{}, many = simd::spread(static_cast<double>(count)), lane{0.0, 1.0, 2.0, 3.0};
  const auto touches = (overlap > none) & (lane < many);
  dem::ContactMotion<Four> motion;
  motion.normal = normal;
  motion.roll = {gather(grains.spin, 0), gather(grains.spin, 1), gather(grains.spin, 2)};
  const Vector arm = (-distance) * normal;
  motion.overlap = touches ? overlap : simd::spread(reference_);  // of the others any that can be evaluated
  motion.root_overlap = simd::root(motion.overlap);
  motion.velocity = Vector{gather(grains.velocity, 0), gather(grains.velocity, 1), gather(grains.velocity, 2)} +
                    cross(motion.roll, arm);
  motion.spin = 0.5 * dot(motion.roll, normal);
  dem::ContactHistory<Four> history{listed.vector(listed.tangential, n), simd::load(&listed.root[n]), {}};
  if constexpr (kRolling) history.rolling = listed.vector(listed.rolling, n);
  const dem::ContactForce<Four> f = Law::template force<kRolling>(of(wall, step), step.dt, motion, history);
  if constexpr (Law::kHistory) {
    const auto keep = lane < many;
    const auto put = [&](std::vector<double>& to, const Four& v) {
      simd::store(&to[n], touches ? v : (keep ? none : simd::load(&to[n])));
    };
    put(listed.tangential[0], history.tangential.x), put(listed.tangential[1], history.tangential.y);
    put(listed.tangential[2], history.tangential.z), put(listed.root, history.root_overlap);
    if constexpr (kRolling) {
      put(listed.rolling[0], history.rolling.x), put(listed.rolling[1], history.rolling.y);
      put(listed.rolling[2], history.rolling.z);
    }
  }
  const Vector force = f.normal * normal + f.tangential;
  const Vector torque = cross(arm, f.tangential) + f.rolling;
  for (std::size_t k = 0; k < count; ++k) {
    if (!(distance[k] >= 0.0) && found.lost < 0) found.lost = g[k];
    if (!(overlap[k] > 0.0)) continue;
    double *const on = grains.force[g[k]], *const turns = grains.torque[g[k]];
    on[0] += force.x[k], on[1] += force.y[k], on[2] += force.z[k];
    turns[0] += torque.x[k], turns[1] += torque.y[k], turns[2] += torque.z[k];
    sums.elastic += f.energy[k];
    dem::add(sums.wall_force, simd::Double4{force.x[k], force.y[k], force.z[k], 0.0});
    if (wall == dem::kFloor) sums.floor_force += force.z[k];
    ++sums.contacts;
    if (overlap[k] > found.overlap) {
      found.overlap = overlap[k];
      found.share = 0.5 * overlap[k] / reference_;
      found.hardest = g[k];
    }
  }
}

template <class Law, bool kRolling>
void WallContacts::evaluate_one(const Grains& grains, int wall, std::size_t n, const Step& step,
                                dem::ContactTotals& sums, Findings& found) {
  using simd::Triple;
  Listed& listed = walls_[wall];
  const int g = listed.grain[n];
  const double r = grains.radius[g], distance = bin_.distance(wall, at(grains, g));
  if (!(distance >= 0.0) && found.lost < 0) found.lost = g;
  dem::ContactCoefficients c = of(wall, step);
  if (r != reference_) c = dem::scaled(c, dem::surface_scale(r / reference_, 0.0));
  const auto vector = [n](const std::array<std::vector<double>, 3>& from) {
    return Triple<double>{from[0][n], from[1][n], from[2][n]};
  };
  dem::ContactHistory<double> history{vector(listed.tangential), listed.root[n], vector(listed.rolling)};
  dem::ContactMotion<double> motion;
  motion.overlap = r - distance;
  if (!(motion.overlap > 0.0)) {
    if (step.losses && listed.root[n] > 0.0)
      sums.sample.power.opening +=
          dem::held_by_springs(c, history.tangential, history.root_overlap, history.rolling) / step.dt;
    listed.take(n, {});
    return;
  }
  motion.normal = dem::Bin::normal(wall);
  const double *const v = grains.velocity[g], *const w = grains.spin[g];
  motion.roll = {w[0], w[1], w[2]};
  const Triple<double> arm = -distance * motion.normal;
  motion.root_overlap = std::sqrt(motion.overlap);
  motion.velocity = Triple<double>{v[0], v[1], v[2]} + cross(motion.roll, arm);
  motion.spin = 0.5 * dot(motion.roll, motion.normal);
  if (step.losses) add(sums.sample, dem::sample_of<Law, kRolling>(c, step.dt, motion, history));
  const dem::ContactForce<double> f = Law::template force<kRolling>(c, step.dt, motion, history);
  if constexpr (Law::kHistory) {
    const Triple<double>&s = history.tangential, &t = history.rolling;
    listed.take(n, {0.0, {}, {s.x, s.y, s.z}, history.root_overlap, {t.x, t.y, t.z}});
  }
  const Triple<double> force = f.normal * motion.normal + f.tangential;
  const Triple<double> torque = cross(arm, f.tangential) + f.rolling;
  double *const on = grains.force[g], *const turns = grains.torque[g];
  on[0] += force.x, on[1] += force.y, on[2] += force.z;
  turns[0] += torque.x, turns[1] += torque.y, turns[2] += torque.z;
  sums.elastic += f.energy;
  dem::add(sums.wall_force, simd::Double4{force.x, force.y, force.z, 0.0});
  if (wall == dem::kFloor) sums.floor_force += force.z;
  ++sums.contacts;
  found.overlap = std::max(found.overlap, motion.overlap);
  if (const double share = 0.5 * motion.overlap / r; share > found.share) found.share = share, found.hardest = g;
}

}  // namespace furrow::terrain::liggghts
