// Steps a bin of grains: contacts between grains, with walls and with tires, gravity, semi-implicit Euler
//   v ← v + dt (F/m + g),   ω ← ω + dt T/I,   x ← x + dt v.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "protocol/archive.hpp"
#include "protocol/messages.hpp"
#include "terrain/dem/contact_mixing.hpp"
#include "terrain/dem/pair_list.hpp"
#include "terrain/dem/surface_contacts.hpp"

namespace furrow::dem {

inline constexpr double kGravity = 9.81;  // m/s², along −z

struct SolverParams {
  LawKind law = LawKind::mindlin;
  bool rolling = false;  // rolling resistance
  GrainProperties grain;
  Bin bin;
  double gravity = kGravity;  // m/s²
  double skin = 0.0;          // neighbours are listed within 2 r + skin, m
  int threads = 1;
};

/// Coefficients per partner; they hold the step of the impulse limit.
struct SolverCoefficients {
  ContactCoefficients pair, floor, side;
};

/// Cumulative since reset_accounts() unless stated.
struct Accounts {
  double contact_work = 0.0;            // ∫ contact forces · relative velocity, J
  double elastic = 0.0;                 // at the last force evaluation, J
  double elastic_start = 0.0;           // J
  Vec3 wall_impulse = Vec3::Zero();     // N s
  Vec3 surface_impulse = Vec3::Zero();  // N s
  double floor_force = 0.0;             // last step, N
  double kinetic = 0.0;                 // now, J
  double height = 0.0;                  // Σ z now, m
  Vec3 velocity = Vec3::Zero();         // Σ v now, m/s
  std::int64_t contacts = 0;            // last step
  double max_overlap = 0.0;             // met since reset, m
  double contact_force = 0.0;           // Σ |F|, N, last measured step
  double net_force = 0.0;               // Σ |net force| of grains, N, last measured step
};

class GrainSolver {
 public:
  explicit GrainSolver(const SolverParams& params);

  const SolverParams& params() const { return params_; }
  void set_threads(int threads) { params_.threads = threads; }
  void set_coefficients(const SolverCoefficients& c) { coefficients_ = c; }
  const SolverCoefficients& coefficients() const { return coefficients_; }
  /// Extra damping of all motion while settling: dv/dt = −drag v, 1/s.
  void set_drag(double drag) { drag_ = drag; }

  /// Puts grains at rest with ids 0, 1, …; w of each position is ignored.
  void place(const std::vector<Quad>& positions);
  Grains& grains() { return grains_; }
  const Grains& grains() const { return grains_; }
  const PairList& pairs() const { return pairs_; }
  SurfaceContacts& surfaces() { return surfaces_; }
  const SurfaceContacts& surfaces() const { return surfaces_; }
  const Accounts& accounts() const { return accounts_; }
  void reset_accounts();
  /// Current index of the grain with this id.
  int index_of(int id) const;

  /// One step. With `measure`, the force sums of Accounts are taken too.
  /// Returns the index of a grain that left the bin or is not finite, or −1.
  int step(double dt, bool measure = false);

  void save(Archive& archive) const;
  void restore(const Archive& archive);

 private:
  template <class Law, bool kRolling>
  void contacts_of_block(int b, double dt, bool measure);
  template <class Law, bool kRolling>
  void evaluate(double dt, bool measure);
  void integrate_block(PairBlock& block, double dt, bool measure);
  void reduce(double dt, bool measure);
  void rebuild();

  SolverParams params_;
  SolverCoefficients coefficients_;
  double drag_ = 0.0;
  Grains grains_;
  PairList pairs_;
  SurfaceContacts surfaces_;
  Accounts accounts_;
  std::vector<std::vector<std::int32_t>> touching_;  // per thread: indices of the touching pairs of a block
};

}  // namespace furrow::dem
