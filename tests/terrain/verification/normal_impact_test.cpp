// Normal impacts, law mindlin: tests 1–3 of Chung & Ooi (2011).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/terrain/few_grains.hpp"
#include "tests/terrain/verification/chung_ooi_2011.hpp"
#include "tests/verification/record.hpp"

namespace furrow::verification {
namespace {

const std::string kHertz = "Hertz 1882, Johnson 1985 sec. 11.4";
constexpr int kSteps = 10000;  // per contact

struct Trace {
  std::vector<double> overlap, time, force;
  /// Force at an abscissa, while that grows, by interpolation, N.
  double at(const std::vector<double>& abscissa, double value) const {
    for (std::size_t k = 1; k < abscissa.size(); ++k)
      if (abscissa[k] >= value) {
        const double share = (value - abscissa[k - 1]) / (abscissa[k] - abscissa[k - 1]);
        return force[k - 1] + share * (force[k] - force[k - 1]);
      }
    return std::nan("");
  }
};

/// Two equal spheres head on, each at `speed`; force, overlap and duration of the contact.
Rebound pair_impact(double radius, double density, const Elastic& material, double speed, Trace& trace) {
  terrain::dem::SolverParams params;
  params.grain = terrain::dem::grain_properties(radius, density);
  params.bin.length = params.bin.width = 80.0 * radius;
  params.gravity = Vec3::Zero();
  params.skin = 0.3 * radius;
  terrain::dem::GrainSolver solver(params);
  ContactMaterial sphere;
  sphere.young_modulus = material.young, sphere.poisson_ratio = material.poisson;
  sphere.restitution = 1.0, sphere.friction = 0.35;
  const auto k = terrain::dem::mix(sphere, sphere, terrain::dem::Partner::grain, params.grain, {});
  solver.set_coefficients({k, k, k});
  // In a direction of no coordinate plane.
  const Vec3 along = Vec3(0.6, -0.64, 0.48).normalized(), middle(40.0 * radius, 0.0, 40.0 * radius);
  solver.place({terrain::dem::quad(middle - radius * along), terrain::dem::quad(middle + radius * along)});
  terrain::dem::set_velocity(solver, 0, speed * along);
  terrain::dem::set_velocity(solver, 1, -speed * along);
  const double dt =
      hertz_impact(k.of<terrain::dem::MindlinLaw>().stiffness, 0.5 * params.grain.mass, 2.0 * speed).duration / kSteps;
  Rebound out;
  int touched = 0;
  for (int step = 0; step < 2 * kSteps; ++step) {
    const double overlap =
        2.0 * radius - (terrain::dem::position(solver, 1) - terrain::dem::position(solver, 0)).norm();
    const Vec3 before = terrain::dem::velocity(solver, 1);
    solver.step(dt);
    const double force = params.grain.mass * (terrain::dem::velocity(solver, 1) - before).norm() / dt;
    const bool touching = solver.accounts().contacts > 0;
    if (touched > 0 && !touching) break;
    touched += touching;
    out.max_force = std::max(out.max_force, force);
    out.max_overlap = std::max(out.max_overlap, overlap);
    trace.overlap.push_back(overlap), trace.time.push_back(touched * dt), trace.force.push_back(force);
  }
  out.duration = touched * dt;
  out.after.normal = terrain::dem::velocity(solver, 1).dot(along);
  return out;
}

TEST(NormalImpact, chung_ooi_2011_test_1_of_two_equal_spheres_is_hertz) {
  struct Case {
    const char* name;
    Elastic material;
    double density;
  };
  for (const Case& one : {Case{"glass", chung_ooi::kGlass, 2800.0}, Case{"limestone", chung_ooi::kLimestone, 2500.0}}) {
    const std::string name = std::string("C&O test 1, pair, ") + one.name;
    const double radius = 0.010, speed = 10.0;
    Trace trace;
    const Rebound out = pair_impact(radius, one.density, one.material, speed, trace);
    const double e_star = 0.5 * one.material.young / (1.0 - one.material.poisson * one.material.poisson);
    const double mass = one.density * 4.0 / 3.0 * M_PI * std::pow(radius, 3);
    const Rebound hertz = hertz_impact(4.0 / 3.0 * e_star * std::sqrt(0.5 * radius), 0.5 * mass, 2.0 * speed);
    verify(name, "largest force, N", out.max_force, hertz.max_force, 1e-3, kHertz);
    verify(name, "largest overlap, m", out.max_overlap, hertz.max_overlap, 1e-3, kHertz);
    verify(name, "duration, s", out.duration, hertz.duration, 1e-3, kHertz);
    verify(name, "rebound speed, m/s", out.after.normal, speed, 1e-3, kHertz);
    if (one.material.young != chung_ooi::kGlass.young) continue;
    Worst curve(name, "force at a displacement, kN", 0.03, std::string(chung_ooi::kSource) + " (digitised)");
    for (const auto& p : chung_ooi::kTest1Force)
      curve.add(1e-3 * trace.at(trace.overlap, 1e-6 * p.x), p.y, 1e-3 * hertz.max_force, brief(p.x));
  }
}

TEST(NormalImpact, chung_ooi_2011_test_2_on_a_rigid_plane_is_hertz) {
  struct Case {
    const char* name;
    Elastic material;
    double density;
  };
  for (const Case& one : {Case{"aluminium alloy", chung_ooi::kAluminium2, 2699.0},
                          Case{"magnesium alloy", chung_ooi::kMagnesium, 1800.0}})
    for (const Ground ground : {Ground::plane, Ground::mesh}) {
      const std::string name = std::string("C&O test 2, ") + name_of(ground) + ", " + one.name;
      const ImpactCase impact{0.1, one.density, one.material, rigid()};
      Trace trace;
      const auto watch = [&](double overlap, double time, double force) {
        trace.overlap.push_back(overlap), trace.time.push_back(time), trace.force.push_back(force);
      };
      const Rebound out = solver_impact(impact, {0.2, 0.0, 0.0}, ground, kSteps, watch);
      const double e_star = one.material.young / (1.0 - one.material.poisson * one.material.poisson);
      const Rebound hertz = hertz_impact(4.0 / 3.0 * e_star * std::sqrt(0.1), impact.mass(), 0.2);
      verify(name, "largest force, N", out.max_force, hertz.max_force, 1e-3, kHertz);
      verify(name, "largest overlap, m", out.max_overlap, hertz.max_overlap, 1e-3, kHertz);
      verify(name, "duration, s", out.duration, hertz.duration, 1e-3, kHertz);
      verify(name, "rebound speed, m/s", out.after.normal, 0.2, 1e-3, kHertz);
      if (one.density != 2699.0) continue;
      Worst curve(name, "force at a time, kN", 0.03, std::string(chung_ooi::kSource) + " (digitised)");
      for (const auto& p : chung_ooi::kTest2History)
        curve.add(1e-3 * trace.at(trace.time, 1e-6 * p.x), p.y, 1e-3 * hertz.max_force, brief(p.x));
    }
}

TEST(NormalImpact, chung_ooi_2011_test_3_rebounds_with_the_restitution_asked_for) {
  struct Case {
    const char* name;
    Elastic material;
    double density;
  };
  for (const Case& one :
       {Case{"aluminium oxide", chung_ooi::kAluminiumOxide, 4000.0}, Case{"cast iron", chung_ooi::kCastIron, 7000.0}})
    for (const Ground ground : {Ground::plane, Ground::mesh}) {
      Worst worst(std::string("C&O test 3, ") + name_of(ground) + ", " + one.name, "restitution", 1e-2,
                  "Antypov & Elliott 2011 doi:10.1209/0295-5075/94/50004");
      for (const double e : {0.2, 0.4, 0.6, 0.8, 1.0}) {
        ImpactCase impact{0.0025, one.density, one.material, rigid()};
        impact.restitution = e;
        worst.add(solver_impact(impact, {3.9, 0.0, 0.0}, ground, kSteps).after.normal / 3.9, e, 0.0, brief(e));
      }
    }
}

}  // namespace
}  // namespace furrow::verification
