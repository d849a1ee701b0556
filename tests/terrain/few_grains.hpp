// A few grains in a bin, for tests of laws and solver.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <span>
#include <vector>

#include "protocol/core/hash.hpp"
#include "terrain/dem/grain_solver.hpp"

namespace furrow::terrain::dem {

struct FewGrains {
  DemOptions options;
  double gravity = 0.0;  // m/s²
  double slope = 0.0;    // rad, of a floor that falls along +x: gravity is turned from −z towards +x
  Precision precision = Precision::full;
  bool activity = false;
  int sample_every = kLossSampleSteps;
  double smallest = 0.0, largest = 0.0;  // m; 0: all have options.radius

  FewGrains() {
    options.length = 0.6;
    options.width = 0.6;
    options.step = 1e-6;
  }

  GrainSolver make(const std::vector<Quad>& positions) const {
    SolverParams params;
    params.law = law_from(options.law);
    params.rolling = options.rolling_friction > 0.0;
    params.grain = grain_properties(options.radius, options.density);
    params.bin.length = options.length;
    params.bin.width = options.width;
    params.bin.periodic_x = options.periodic_x;
    params.bin.periodic_y = options.periodic_y();
    params.gravity = gravity * Vec3(std::sin(slope), 0.0, -std::cos(slope));
    params.precision = precision;
    params.activity = activity;
    params.sample_every = sample_every;
    params.smallest = smallest, params.largest = largest;
    params.skin = 0.3 * options.radius;
    GrainSolver solver(params);
    solver.set_coefficients(coefficients());
    solver.place(positions);
    return solver;
  }
  SolverCoefficients coefficients() const {
    const ContactMaterial material = grain_material(options);
    const GrainProperties grain = grain_properties(options.radius, options.density);
    const ContactCoefficients wall = mix(material, material, Partner::surface, grain, options);
    return {mix(material, material, Partner::grain, grain, options), wall, wall};
  }
  double mass() const { return grain_properties(options.radius, options.density).mass; }
  /// Height of the centre at which the floor carries a grain's weight, m.
  double resting_height() const { return options.radius - resting_overlap(); }
  double resting_overlap() const { return std::pow(mass() * gravity * std::cos(slope) / floor_stiffness(), 2.0 / 3.0); }
  /// Coefficients in the form that the law uses. @pre options.law is its name
  template <class Law>
  typename Law::template Coefficients<double> pair() const {
    return coefficients().pair.template of<Law>();
  }
  template <class Law>
  typename Law::template Coefficients<double> floor() const {
    return coefficients().floor.template of<Law>();
  }
  /// K of F_e = K δ^{3/2}, N/m^1.5.
  double pair_stiffness() const {
    return with_law(law_from(options.law), [&](auto law) { return pair<decltype(law)>().stiffness; });
  }
  double floor_stiffness() const {
    return with_law(law_from(options.law), [&](auto law) { return floor<decltype(law)>().stiffness; });
  }
};

inline std::uint64_t hash_of(const GrainSolver& s) {
  Hash hash;
  for (const auto* a : {&s.grains().position, &s.grains().velocity, &s.grains().spin})
    hash.add(std::span(*a).first(s.grains().count));
  return hash.value();
}

/// Uniformly distributed numbers from −1 to 1.
class Uniform {
 public:
  explicit Uniform(std::uint64_t seed) : bits_(seed) {}
  double operator()() { return static_cast<double>(bits_() >> 11) * 0x1p-52 - 1.0; }

 private:
  std::mt19937_64 bits_;
};

inline void run(GrainSolver& s, double step, std::int64_t count) {
  for (std::int64_t k = 0; k < count; ++k) ASSERT_EQ(s.step(step), -1) << k;
}
/// A solver that continues from the saved state of `s`.
inline GrainSolver restored(const GrainSolver& s, int threads = 1) {
  Archive archive;
  s.save(archive);
  SolverParams params = s.params();
  params.threads = threads;
  GrainSolver again(params);
  again.set_coefficients(s.coefficients());
  again.restore(archive);
  return again;
}
/// Checks that one thread, two threads and a solver restored half-way make the same steps.
template <class Make>
void expect_same_bits(Make make, double step, int steps) {
  GrainSolver one = make(), two = make();
  two.set_threads(2);
  run(one, step, steps), run(two, step, steps);
  EXPECT_EQ(hash_of(one), hash_of(two));
  EXPECT_EQ(one.accounts().contact_work, two.accounts().contact_work);
  GrainSolver again = restored(one);
  const auto rebuilds = one.rebuilds();
  EXPECT_GT(rebuilds, 1);
  run(one, step, steps), run(again, step, steps);
  EXPECT_GT(one.rebuilds(), rebuilds);
  EXPECT_EQ(one.rebuilds(), again.rebuilds());
  EXPECT_EQ(hash_of(one), hash_of(again));
  EXPECT_EQ(one.accounts().contact_work, again.accounts().contact_work);
}
/// Checks that momentum changes by the walls' impulse and that the energy account closes. @pre the accounts are new
inline void expect_books_close(GrainSolver& s, double step, int steps, double tolerance) {
  const Vec3 p0 = s.accounts().velocity;
  const double k0 = s.accounts().kinetic, m = s.params().grain.mass;
  run(s, step, steps);
  const Accounts& a = s.accounts();
  EXPECT_LT((m * (a.velocity - p0) - a.wall_impulse).norm(), tolerance * m * s.grains().count);
  const double dissipation = -a.contact_work - (a.elastic - a.elastic_start);
  EXPECT_NEAR(a.kinetic + a.elastic - a.elastic_start + dissipation, k0, 1e-9 * k0);
  EXPECT_GT(dissipation, 0.05 * k0);
}
/// Steps until grains have touched and parted. @returns whether they have
inline bool step_until_parted(GrainSolver& s, double step, int most) {
  bool touched = false;
  for (int k = 0; k < most; ++k) {
    s.step(step);
    const bool now = s.accounts().contacts > 0;
    if (touched && !now) return true;
    touched = now;
  }
  return false;
}
inline Vec3 vec(const Quad& q) { return {q.x, q.y, q.z}; }
inline Quad quad(const Vec3& v) { return {v.x(), v.y(), v.z(), 0.0}; }
inline Vec3 position(const GrainSolver& s, int id) { return vec(s.grains().position[s.index_of(id)]); }
inline Vec3 velocity(const GrainSolver& s, int id) { return vec(s.grains().velocity[s.index_of(id)]); }
inline Vec3 spin(const GrainSolver& s, int id) { return vec(s.grains().spin[s.index_of(id)]); }
inline void set_velocity(GrainSolver& s, int id, const Vec3& v) { s.grains().velocity[s.index_of(id)] = quad(v); }
inline void set_spin(GrainSolver& s, int id, const Vec3& w) { s.grains().spin[s.index_of(id)] = quad(w); }

}  // namespace furrow::terrain::dem
