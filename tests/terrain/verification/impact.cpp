#include "tests/terrain/verification/impact.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tests/terrain/verification/engine_grains.hpp"

namespace furrow::verification {
namespace {

constexpr double kPi = std::numbers::pi;

/// Coefficients of the contact equations, from the cited formulas and not from terrain/dem/contact/mindlin_law.hpp.
struct Law {
  double radius, mass, inertia;
  double stiffness, damping, shear_stiffness, shear_damping, friction;

  explicit Law(const ImpactCase& c) : radius(c.radius), mass(c.mass()), friction(c.friction) {
    inertia = 0.4 * mass * radius * radius;
    const double compliance = (1.0 - c.sphere.poisson * c.sphere.poisson) / c.sphere.young +
                              (1.0 - c.partner.poisson * c.partner.poisson) / c.partner.young;
    const auto shear = [](const Elastic& e) { return (2.0 - e.poisson) / (e.young / (2.0 * (1.0 + e.poisson))); };
    const double e_star = 1.0 / compliance, g_star = 1.0 / (shear(c.sphere) + shear(c.partner));
    const double root_r = std::sqrt(1.0 / (1.0 / c.radius + 1.0 / c.partner_radius));
    const double l = std::log(c.restitution), beta = -l / std::sqrt(l * l + kPi * kPi);
    const double factor = 2.0 * std::sqrt(5.0 / 6.0) * beta;
    stiffness = 4.0 / 3.0 * e_star * root_r;
    shear_stiffness = 8.0 * g_star * root_r;
    damping = factor * std::sqrt(2.0 * e_star * root_r * mass);
    shear_damping = factor * std::sqrt(shear_stiffness * 2.0 / 7.0 * mass);
  }
  double elastic(double overlap, double approach) const {
    return stiffness * std::pow(overlap, 1.5) + damping * std::pow(overlap, 0.25) * approach;
  }
};

/// δ, δ̇, v, ω, spring force T.
using State = std::array<double, 5>;

double total_shear(const Law& law, const State& s, double sliding) {
  const double limit = law.friction * std::max(law.elastic(s[0], s[1]), 0.0);
  return std::clamp(s[4] - law.shear_damping * std::pow(s[0], 0.25) * sliding, -limit, limit);
}

State rate(const Law& law, State s) {
  s[0] = std::max(s[0], 1e-300);
  const double arm = law.radius - s[0], sliding = s[2] - arm * s[3];
  const double shear = total_shear(law, s, sliding);
  const double unloading = s[1] < 0.0 ? 0.5 * s[4] * s[1] / s[0] : 0.0;
  return {s[1], -law.elastic(s[0], s[1]) / law.mass, shear / law.mass, -arm * shear / law.inertia,
          -law.shear_stiffness * std::sqrt(s[0]) * sliding + unloading};
}

State advanced(const State& s, const State& by, double h) {
  State out = s;
  for (std::size_t k = 0; k < out.size(); ++k) out[k] += h * by[k];
  return out;
}

/// Limits spring and damper to the Coulomb limit, and sets the remaining spring.
void cut(const Law& law, State& s) {
  const double sliding = s[2] - (law.radius - s[0]) * s[3];
  s[4] = total_shear(law, s, sliding) + law.shear_damping * std::pow(s[0], 0.25) * sliding;
}

/// Value and lim √(1−x) d/dx at x = 1 of ₂F₁(a, b; c; x) with c − a − b = ½ [DLMF 15.4.20, 15.4.23].
struct AtOne {
  double value, slope;
};
AtOne hypergeometric_at_one(double a, double b, double c) {
  const double half = std::sqrt(kPi);
  return {std::tgamma(c) * half / (std::tgamma(c - a) * std::tgamma(c - b)),
          std::tgamma(c) * half / (std::tgamma(a) * std::tgamma(b))};
}

terrain::dem::ContactCoefficients solver_coefficients(const ImpactCase& c) {
  const terrain::dem::GrainProperties grain = terrain::dem::grain_properties(c.radius, c.density);
  ContactMaterial sphere, partner;
  sphere.young_modulus = c.sphere.young, sphere.poisson_ratio = c.sphere.poisson;
  partner.young_modulus = c.partner.young, partner.poisson_ratio = c.partner.poisson;
  sphere.friction = partner.friction = c.friction;
  sphere.restitution = partner.restitution = c.restitution;
  auto k = terrain::dem::mix(sphere, partner, terrain::dem::Partner::surface, grain, {}).of<terrain::dem::MindlinLaw>();
  // The engine's surfaces are flat; a round partner is represented by its R*.
  const double share = 1.0 / (1.0 + c.radius / c.partner_radius);
  k.stiffness *= std::sqrt(share), k.shear_stiffness *= std::sqrt(share);
  k.damping *= std::pow(share, 0.25), k.shear_damping *= std::pow(share, 0.25);
  return terrain::dem::ContactCoefficients(k);
}

using terrain::dem::quad;
using terrain::dem::vec;

}  // namespace

double ImpactCase::mass() const { return density * 4.0 / 3.0 * kPi * radius * radius * radius; }

Elastic rigid() { return {1e22, 0.3}; }

const char* name_of(Ground ground) { return ground == Ground::plane ? "plane" : "mesh"; }

Rebound hertz_impact(double stiffness, double mass, double speed) {
  Rebound out;
  out.after.normal = speed;
  out.max_overlap = std::pow(5.0 * mass * speed * speed / (4.0 * stiffness), 0.4);
  out.max_force = stiffness * std::pow(out.max_overlap, 1.5);
  // T = 2 δ_m/v ∫ dy/√(1 − y^{5/2}) = 2 δ_m/v · 2/5 B(2/5, 1/2) = 2.9432 δ_m/v
  out.duration = 0.8 * std::beta(0.4, 0.5) * out.max_overlap / speed;
  return out;
}

Rebound solver_impact(const ImpactCase& impact, const Motion& before, Ground ground, int steps, const Watch& watch) {
  const double r = impact.radius;
  terrain::dem::SolverParams params;
  params.grain = terrain::dem::grain_properties(r, impact.density);
  params.bin.length = params.bin.width = 80.0 * r;
  params.gravity = Vec3::Zero();
  params.skin = 0.3 * r;
  terrain::dem::GrainSolver solver(params);
  const terrain::dem::ContactCoefficients k = solver_coefficients(impact);
  solver.set_coefficients({k, k, k});

  const bool mesh = ground == Ground::mesh;
  const Quat turn(Eigen::AngleAxisd(mesh ? 0.7 : 0.0, Vec3(0.3, -0.8, 0.5).normalized()));
  const Vec3 foot(40.0 * r, 0.0, mesh ? 20.0 * r : 0.0), up = turn * Vec3::UnitZ();
  solver.place({terrain::dem::quad(foot + r * up)});
  if (mesh) {
    testing::Surface sheet = testing::sheet(-4.3 * r, -3.83 * r, 2.0 * r, 4, 4, [](double, double) { return 0.0; });
    for (Vec3& x : sheet.vertex) x = foot + turn * x;
    attach(solver, sheet, k);
  }
  solver.grains().velocity[0] = terrain::dem::quad(turn * Vec3(before.tangential, 0.0, -before.normal));
  solver.grains().spin[0] = terrain::dem::quad(turn * Vec3(0.0, before.spin, 0.0));

  const double hertz =
      hertz_impact(k.of<terrain::dem::MindlinLaw>().stiffness, params.grain.mass, before.normal).duration;
  const double dt = hertz / steps;
  Rebound out;
  double speed = -before.normal;
  int touched = 0;
  for (int step = 0; step < 20 * steps; ++step) {
    const double overlap = r - (terrain::dem::vec(solver.grains().position[0]) - foot).dot(up);
    solver.step(dt);
    const double now = terrain::dem::vec(solver.grains().velocity[0]).dot(up),
                 force = params.grain.mass * (now - speed) / dt;
    speed = now;
    const bool touching = solver.accounts().contacts > 0;
    if (touching && watch) watch(overlap, touched * dt, force);
    out.max_force = std::max(out.max_force, force);
    out.max_overlap = std::max(out.max_overlap, overlap);
    if (touched > 0 && !touching) break;
    touched += touching;
  }
  out.duration = touched * dt;
  const Vec3 v = turn.conjugate() * terrain::dem::vec(solver.grains().velocity[0]);
  const Vec3 w = turn.conjugate() * terrain::dem::vec(solver.grains().spin[0]);
  out.after = {v.z(), v.x(), w.y()};
  return out;
}

Rebound integrated_impact(const ImpactCase& impact, const Motion& before) {
  constexpr int kSteps = 30000;
  const Law law(impact);
  const double h = hertz_impact(law.stiffness, law.mass, before.normal).duration / kSteps;
  State s{1e-9 * h * before.normal, before.normal, before.tangential, before.spin, 0.0};
  Rebound out;
  for (int step = 0; step < 20 * kSteps && s[0] > 0.0; ++step) {
    const State k1 = rate(law, s), k2 = rate(law, advanced(s, k1, 0.5 * h)), k3 = rate(law, advanced(s, k2, 0.5 * h)),
                k4 = rate(law, advanced(s, k3, h));
    for (std::size_t k = 0; k < s.size(); ++k) s[k] += h / 6.0 * (k1[k] + 2.0 * k2[k] + 2.0 * k3[k] + k4[k]);
    if (!(s[0] > 0.0)) break;
    cut(law, s);
    out.duration += h;
    out.max_overlap = std::max(out.max_overlap, s[0]);
    out.max_force = std::max(out.max_force, law.elastic(s[0], s[1]));
  }
  out.after = {-s[1], s[2], s[3]};
  return out;
}

Motion sliding_rebound(const ImpactCase& impact, const Motion& before) {
  const double way = before.sliding(impact.radius) > 0.0 ? 1.0 : -1.0;
  const double impulse = way * impact.friction * (1.0 + impact.restitution) * before.normal;
  return {impact.restitution * before.normal, before.tangential - impulse, before.spin + 2.5 * impulse / impact.radius};
}

bool slides_throughout(const ImpactCase& impact, const Motion& before) {
  return std::abs(before.sliding(impact.radius)) >= 3.5 * impact.friction * (1.0 + impact.restitution) * before.normal;
}

// With x = (δ/δ_m)^{5/2}, δ̇² = v_n² (1 − x), and λ = 7/2 · 8G*/(2E*), neglecting δ against R:
//   loading,   Ṫ = −8G*√R √δ v_s:                x(1−x) v″ + [3/5 − 11/10 x] v′ + 3/10 λ v = 0
//   unloading, Ṫ = −8G*√R √δ v_s + T δ̇/(2δ):     x(1−x) v″ + [2/5 −  9/10 x] v′ + 3/10 λ v = 0
// Both are Gauss' equation with c − a − b = ½. Loading starts with T = 0: v = v₀ ₂F₁(a, b; 3/5; x), of which λ = 1 is
// the approach √(1−x) itself [the loading half: Jäger 1994, Appl. Mech. Rev. 47:35]. Unloading:
//   v = A ₂F₁(a, b; 2/5; x) + B x^{3/5} ₂F₁(a + 3/5, b + 3/5; 8/5; x),
// matched at x = 1 in v and in v̇ ∝ ±√(1−x) v′. At the end x = 0 and v = A.
double no_slip_restitution(const ImpactCase& impact) {
  const Law law(impact);
  const double lambda = 3.5 * law.shear_stiffness / (1.5 * law.stiffness);
  const auto roots = [&](double sum) {
    const double root = std::sqrt(sum * sum + 1.2 * lambda);
    return std::array{0.5 * (sum + root), 0.5 * (sum - root)};
  };
  const auto in = roots(0.1), back = roots(-0.1);
  const AtOne loading = hypergeometric_at_one(in[0], in[1], 0.6);
  const AtOne first = hypergeometric_at_one(back[0], back[1], 0.4);
  const AtOne second = hypergeometric_at_one(back[0] + 0.6, back[1] + 0.6, 1.6);
  const double determinant = first.value * second.slope - second.value * first.slope;
  const double a = (loading.value * second.slope + second.value * loading.slope) / determinant;
  return -a;
}

}  // namespace furrow::verification
