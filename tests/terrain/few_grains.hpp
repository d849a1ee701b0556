// A handful of grains in a bin, for tests of laws and solver.
#pragma once

#include <cmath>
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
  /// The same as the law itself takes them. @pre options.law is its name
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

inline Vec3 vec(const Quad& q) { return {q.x, q.y, q.z}; }
inline Quad quad(const Vec3& v) { return {v.x(), v.y(), v.z(), 0.0}; }
inline Vec3 position(const GrainSolver& s, int id) { return vec(s.grains().position[s.index_of(id)]); }
inline Vec3 velocity(const GrainSolver& s, int id) { return vec(s.grains().velocity[s.index_of(id)]); }
inline Vec3 spin(const GrainSolver& s, int id) { return vec(s.grains().spin[s.index_of(id)]); }
inline void set_velocity(GrainSolver& s, int id, const Vec3& v) { s.grains().velocity[s.index_of(id)] = quad(v); }
inline void set_spin(GrainSolver& s, int id, const Vec3& w) { s.grains().spin[s.index_of(id)] = quad(w); }

}  // namespace furrow::terrain::dem
