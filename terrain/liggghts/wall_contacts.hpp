// The contacts of one rank's grains with the walls of the bin. The grains that may touch a wall are listed when the
// lists of pairs are made. The histories are stored in the same order, wall by wall, so that four contacts are
// evaluated at a time without any search. Before grains change their indices the histories move to the grains, which
// carry them from rank to rank (engine.hpp).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include "protocol/core/assert.hpp"
#include "terrain/dem/bin.hpp"
#include "terrain/dem/contact/kinematics.hpp"
#include "terrain/dem/contact/laws.hpp"
#include "terrain/dem/parcel.hpp"
#include "terrain/dem/wall_forces.hpp"
#include "terrain/liggghts/engine.hpp"

namespace furrow::terrain::liggghts {

class WallContacts {
 public:
  struct Findings {
    int lost = -1;         // a grain whose centre is not within the walls
    int hardest = -1;      // a grain of the contact with the largest share
    double share = 0.0;    // overlap of that contact over the diameter, -
    double overlap = 0.0;  // largest, m
  };
  struct Step {
    const dem::SolverCoefficients& coefficients;
    double dt;    // s
    bool losses;  // whether losses are sampled
  };

  /// @param reference  the radius of the coefficients, m  @pre reference > 0
  WallContacts(const dem::Bin& bin, double reference) : bin_(bin), reference_(reference) {
    FURROW_ASSERT(reference > 0.0, reference);
  }

  /// Lists the grains within `room` of touching a wall, m, in this order. Takes over the histories of walls that they
  /// carry.
  /// @returns a grain whose centre is not within the walls
  std::optional<int> list(const OwnGrains& grains, std::span<const std::int32_t> order, double room);
  /// Moves the histories to the grains, whose indices may then change; list() takes them back.
  void hand_back(const OwnGrains& grains);
  /// Call it when the grains were replaced: discards all histories.
  void forget();
  /// Calls see(grain, history) for all histories, wall by wall.
  template <class See>
  void for_touching(const See& see) const {
    for (int wall = 0; wall < dem::kWalls; ++wall)
      for (std::size_t n = 0; n < walls_[wall].count; ++n)
        if (walls_[wall].root[n] > 0.0) see(walls_[wall].grain[n], walls_[wall].carried(wall, n));
  }

  /// Adds the forces of walls to grains before index `last` of that order that were not handled since begin().
  /// @pre radii of listed grains are `reference` unless kSizes; step.dt > 0
  template <class Law, bool kRolling, bool kSizes>
  void add_forces(const OwnGrains& grains, int last, const Step& step, dem::ContactTotals& sums, Findings& found);
  void begin() { next_ = {}; }

 private:
  static constexpr std::size_t kLanes = simd::kDoubleLanes;

  /// The grains that may touch one wall, with their histories. Arrays have kLanes extra elements.
  struct Listed {
    std::size_t count = 0;
    std::vector<int> grain, place;                           // index in OwnGrains, index in the order
    std::array<std::vector<double>, 3> tangential, rolling;  // springs on the grain, N, N m
    std::vector<double> root;                                // √δ of the previous step, √m; 0: apart

    void clear();
    void add(int g, int at);
    void make_room();
    void copy(std::size_t to, const Listed& from, std::size_t n);
    Carried carried(int wall, std::size_t n) const;
    template <class T>
    static simd::Triple<T> vector(const std::array<std::vector<double>, 3>& of, std::size_t n) {
      return {simd::load_lanes<T>(&of[0][n]), simd::load_lanes<T>(&of[1][n]), simd::load_lanes<T>(&of[2][n])};
    }
    void take(std::size_t n, const Carried& c);
  };
  using Grains = OwnGrains;
  /// Evaluates `count` contacts from n on, at most as many as T has lanes. Further lanes are evaluated as grains that
  /// do not touch.
  template <class T, class Law, bool kRolling, bool kSizes>
  void evaluate(const Grains& grains, int wall, std::size_t n, std::size_t count, const Step& step,
                dem::ContactTotals& sums, Findings& found);
  void remember();
  void take_carried(const OwnGrains& grains);
  const dem::ContactCoefficients& of(int wall, const Step& step) const {
    return wall == dem::kFloor ? step.coefficients.floor : step.coefficients.side;
  }
  template <class T>
  static simd::Triple<T> gather(const double (*from)[3], const int* g) {
    const auto along = [&](int k) {
      if constexpr (std::is_same_v<T, double>)
        return from[g[0]][k];
      else
        return T{from[g[0]][k], from[g[1]][k], from[g[2]][k], from[g[3]][k]};
    };
    return {along(0), along(1), along(2)};
  }
  static double lane(double v, std::size_t) { return v; }
  static double lane(const simd::Double4& v, std::size_t k) { return v[k]; }
  dem::Quad at(const Grains& grains, int g) const {
    const double* const x = grains.position[g];
    return {x[0], x[1], x[2], grains.radius[g]};
  }

  dem::Bin bin_;
  double reference_;  // m
  std::array<Listed, dem::kWalls> walls_, before_;
  std::array<std::size_t, dem::kWalls> next_{};  // next contact of each wall, in this step
  bool numbered_ = false;                        // the indices in walls_ are those of the present grains
  std::vector<int> before_at_;                   // for each grain its index among the previous ones; −1: none
};

template <class Law, bool kRolling, bool kSizes>
void WallContacts::add_forces(const OwnGrains& grains, int last, const Step& step, dem::ContactTotals& sums,
                              Findings& found) {
  FURROW_ASSERT(step.dt > 0.0, step.dt);
  for (int wall = 0; wall < dem::kWalls; ++wall) {
    const Listed& listed = walls_[wall];
    std::size_t& next = next_[wall];
    std::size_t end = next;
    while (end < listed.count && listed.place[end] < last) ++end;
    if (step.losses)  // one by one, so that the sums of losses have a fixed order
      for (; next < end; ++next) evaluate<double, Law, kRolling, kSizes>(grains, wall, next, 1, step, sums, found);
    for (; next < end; next += std::min(kLanes, end - next))
      evaluate<simd::Double4, Law, kRolling, kSizes>(grains, wall, next, std::min(kLanes, end - next), step, sums,
                                                     found);
  }
}

template <class T, class Law, bool kRolling, bool kSizes>
void WallContacts::evaluate(const Grains& grains, int wall, std::size_t n, std::size_t count, const Step& step,
                            dem::ContactTotals& sums, Findings& found) {
  using simd::constant;
  constexpr bool kOne = std::is_same_v<T, double>;
  Listed& listed = walls_[wall];
  const int* const g = listed.grain.data() + n;
  const simd::Triple<double> n_of = dem::Bin::normal(wall);
  const T distance = bin_.distance(wall, gather<T>(grains.position, g));
  T radius = constant<T>(reference_), order{};
  if constexpr (kSizes && kOne) radius = grains.radius[g[0]];
  if constexpr (kSizes && !kOne)
    radius = T{grains.radius[g[0]], grains.radius[g[1]], grains.radius[g[2]], grains.radius[g[3]]};
  if constexpr (!kOne) order = T{0.0, 1.0, 2.0, 3.0};
  const T overlap = radius - distance, none{}, many = constant<T>(static_cast<double>(count));
  const auto touches = (overlap > none) & (order < many);
  const dem::WallPoint<T> at =
      dem::point_on_wall<T>({constant<T>(n_of.x), constant<T>(n_of.y), constant<T>(n_of.z)}, distance,
                            touches ? overlap : radius,  // for the others, any overlap that can be evaluated
                            gather<T>(grains.velocity, g), gather<T>(grains.spin, g));
  dem::ContactHistory<T> history{listed.vector<T>(listed.tangential, n), simd::load_lanes<T>(&listed.root[n]), {}};
  if constexpr (kRolling) history.rolling = listed.vector<T>(listed.rolling, n);
  const auto reference = of(wall, step).template of<Law>();
  const auto c = [&] {
    if constexpr (kSizes)
      return Law::scaled(reference, dem::surface_scale(radius / reference_, 0.0));
    else
      return reference;
  }();
  if constexpr (kOne) {
    if (step.losses && touches) add(sums.sample, dem::sample_of<Law, kRolling>(c, step.dt, at.motion, history));
    if (step.losses && !touches) sums.sample.power.opening += Law::held(c, 0.0, history).tangential / step.dt;
  }
  const dem::ContactForce<T> f = Law::template force<kRolling>(c, step.dt, at.motion, history);
  if constexpr (Law::kHistory) {
    const auto keep = order < many;
    const auto put = [&](std::vector<double>& to, const T& v) {
      simd::store_lanes(&to[n], touches ? v : (keep ? none : simd::load_lanes<T>(&to[n])));
    };
    put(listed.tangential[0], history.tangential.x), put(listed.tangential[1], history.tangential.y);
    put(listed.tangential[2], history.tangential.z), put(listed.root, history.root_overlap);
    if constexpr (kRolling) {
      put(listed.rolling[0], history.rolling.x), put(listed.rolling[1], history.rolling.y);
      put(listed.rolling[2], history.rolling.z);
    }
  }
  const dem::SurfaceLoads<T> loads = dem::wall_loads(f, at);
  for (std::size_t k = 0; k < count; ++k) {
    const double deep = lane(overlap, k);
    if (!(lane(distance, k) >= 0.0) && found.lost < 0) found.lost = g[k];
    if (!(deep > 0.0)) continue;
    double *const on = grains.force[g[k]], *const turns = grains.torque[g[k]];
    const dem::Quad force{lane(loads.force.x, k), lane(loads.force.y, k), lane(loads.force.z, k), 0.0};
    on[0] += force.x, on[1] += force.y, on[2] += force.z;
    turns[0] += lane(loads.torque.x, k), turns[1] += lane(loads.torque.y, k), turns[2] += lane(loads.torque.z, k);
    sums.elastic += lane(f.energy, k);
    dem::add(sums.wall_force, dem::load(force));
    if (wall == dem::kFloor) sums.floor_force += force.z;
    ++sums.contacts;
    found.overlap = std::max(found.overlap, deep);
    if (const double share = 0.5 * deep / lane(radius, k); share > found.share)
      found.share = share, found.hardest = g[k];
  }
}

}  // namespace furrow::terrain::liggghts
