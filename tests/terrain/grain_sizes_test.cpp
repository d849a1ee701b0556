// Grains of several sizes: scaled coefficients, pairs against closed forms, conservation, beds.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "protocol/core/constants.hpp"
#include "protocol/core/error.hpp"
#include "terrain/dem/beds/bed_preparation.hpp"
#include "terrain/dem/beds/bed_statistics.hpp"
#include "terrain/dem/contact/size_scale.hpp"
#include "terrain/dem/dem_terrain.hpp"
#include "terrain/dem/grain_sizes.hpp"
#include "terrain/dem/solver_setup.hpp"
#include "tests/refusal.hpp"
#include "tests/terrain/few_grains.hpp"

namespace furrow::terrain::dem {
namespace {

std::array<double, 7> sized_part(const MindlinLaw::Coefficients<double>& c) {
  return {c.stiffness,      c.damping,     c.shear_stiffness, c.shear_damping,
          c.cohesion_force, c.rolling_arm, c.rolling_damping};
}

void expect_same(const MindlinLaw::Coefficients<double>& a, const MindlinLaw::Coefficients<double>& b) {
  const auto x = sized_part(a), y = sized_part(b);
  for (std::size_t k = 0; k < x.size(); ++k) EXPECT_NEAR(x[k] / y[k], 1.0, 1e-14) << k;
  EXPECT_EQ(a.friction, b.friction);
}

TEST(GrainSizes, scaled_coefficients_are_those_mixed_for_that_size) {
  DemOptions o;
  o.cohesion = 50e3;
  o.rolling_friction = 0.1;
  const ContactMaterial material = grain_material(o);
  ContactMaterial tread = material;
  tread.young_modulus *= 0.3, tread.area_density = 12.0;
  const GrainProperties reference = grain_properties(o.radius, o.density);
  const auto mixed = [&](const ContactMaterial& other, Partner partner, const GrainProperties& grain) {
    return mix(material, other, partner, grain, o).of<MindlinLaw>();
  };
  for (const double size : {0.4, 0.9, 1.0, 1.7}) {
    const GrainProperties other = grain_properties(size * o.radius, o.density);
    expect_same(MindlinLaw::scaled(mixed(material, Partner::grain, reference), pair_scale<double>(size, size)),
                mixed(material, Partner::grain, other));
    for (const ContactMaterial& surface : {material, tread})
      expect_same(MindlinLaw::scaled(mixed(surface, Partner::surface, reference),
                                     surface_scale(size, mass_share(reference, surface))),
                  mixed(surface, Partner::surface, other));
  }
}

/// A large partner is a wall: R* → r, m* → m.
TEST(GrainSizes, against_a_giant_the_pair_is_a_contact_with_a_wall) {
  DemOptions o;
  o.cohesion = 50e3;
  o.rolling_friction = 0.1;
  const ContactMaterial material = grain_material(o);
  const GrainProperties reference = grain_properties(o.radius, o.density);
  const auto pair = mix(material, material, Partner::grain, reference, o).of<MindlinLaw>();
  const auto wall = mix(material, material, Partner::surface, reference, o).of<MindlinLaw>();
  const auto giant = sized_part(MindlinLaw::scaled(pair, pair_scale<double>(1.0, 1e9))), flat = sized_part(wall);
  for (std::size_t k = 0; k < flat.size(); ++k) EXPECT_NEAR(giant[k] / flat[k], 1.0, 1e-8) << k;
}

/// A sphere of radius 9 mm and one of 4 mm, with coefficients stated for 6 mm.
struct Unequal {
  FewGrains few;
  double a = 0.009, b = 0.004;  // m
  Unequal() {
    few.smallest = b, few.largest = a;
    few.options.step = 2e-7;
  }
  double mass(double r) const { return grain_properties(r, few.options.density).mass; }
  double inertia(double r) const { return grain_properties(r, few.options.density).inertia; }
  double reduced_mass() const { return 1.0 / (1.0 / mass(a) + 1.0 / mass(b)); }
  double reduced_radius() const { return a * b / (a + b); }
  GrainSolver make() const { return few.make({{0.3, 0.0, 0.3, a}, {0.3 + (a + b) * (1.0 + 1e-6), 0.0, 0.3, b}}); }
};

struct Meeting {
  double duration = 0.0, overlap = 0.0;  // s, m
};

/// Steps until the two have touched and parted.
Meeting meet(GrainSolver& s, double dt) {
  Meeting m;
  for (int k = 0; k < 400000; ++k) {
    s.step(dt);
    if (s.accounts().contacts > 0) m.duration += dt;
    if (m.duration > 0.0 && s.accounts().contacts == 0) break;
  }
  m.overlap = s.accounts().max_overlap;
  return m;
}

/// [Hertz 1882; Johnson 1985, Contact Mechanics, § 11.4] with R* and m* of both.
TEST(GrainSizes, elastic_impact_of_unequal_spheres_is_hertzs) {
  for (const Precision precision : {Precision::full, Precision::mixed}) {
    Unequal u;
    u.few.precision = precision;
    u.few.options.restitution = 1.0;
    GrainSolver s = u.make();
    const double speed = 0.7;
    set_velocity(s, 1, {-speed, 0, 0});
    const Meeting m = meet(s, u.few.options.step);
    const double e_star = 0.5 * u.few.options.young_modulus / (1.0 - std::pow(u.few.options.poisson_ratio, 2));
    const double stiffness = 4.0 / 3.0 * e_star * std::sqrt(u.reduced_radius());
    const double deepest = std::pow(1.25 * u.reduced_mass() * speed * speed / stiffness, 0.4);
    EXPECT_NEAR(m.overlap / deepest, 1.0, 2e-4);
    EXPECT_NEAR(m.duration / (2.9432 * deepest / speed), 1.0, 2e-3);
    const double ratio = u.mass(u.b) / u.mass(u.a);
    EXPECT_NEAR(velocity(s, 0).x(), -2.0 * speed * ratio / (1.0 + ratio), 2e-4 * speed);
  }
}

TEST(GrainSizes, restitution_of_unequal_spheres_is_the_one_asked_for) {
  for (const double e : {0.2, 0.6, 0.9}) {
    Unequal u;
    u.few.options.restitution = e;
    GrainSolver s = u.make();
    set_velocity(s, 1, {-0.5, 0, 0});
    meet(s, u.few.options.step);
    EXPECT_NEAR((velocity(s, 1) - velocity(s, 0)).x(), 0.5 * e, 1e-3) << e;
  }
}

/// Rigid bodies that slide throughout: friction impulse P = μ (1 + e) m* u, spins 5/2 P/(m r). They are stiff, so that
/// the line of centres hardly turns.
TEST(GrainSizes, sliding_impact_of_unequal_spheres_gives_both_their_spin) {
  Unequal u;
  u.few.options.young_modulus = 2.5e12;
  u.few.options.restitution = 1.0;
  u.few.options.friction = 0.1;
  u.few.options.step = 2e-9;
  GrainSolver s = u.make();
  const double speed = 0.3;
  set_velocity(s, 1, {-speed, 0, 2.0 * speed});
  meet(s, u.few.options.step);
  const double impulse = 2.0 * u.reduced_mass() * speed * u.few.options.friction;
  const auto spin_after = [&](double r) { return 2.5 * impulse / (u.mass(r) * r); };
  EXPECT_NEAR(velocity(s, 0).z() / (impulse / u.mass(u.a)), 1.0, 5e-3);
  EXPECT_NEAR(spin(s, 0).y() / spin_after(u.a), -1.0, 2e-3);
  EXPECT_NEAR(spin(s, 1).y() / spin_after(u.b), -1.0, 2e-3);
}

TEST(GrainSizes, oblique_impact_keeps_momentum_and_angular_momentum) {
  struct Case {
    const char* law;
    double a, b;  // m
  };
  for (const auto& [law, a, b] :
       {Case{"mindlin", 0.009, 0.004}, {"mindlin", 0.006, 0.006}, {"hertz_tanh", 0.006, 0.006}})
    for (const double rolling : {0.0, 0.2}) {
      Unequal u;
      u.a = a, u.b = b;
      if (a == b) u.few.smallest = u.few.largest = 0.0;
      u.few.options.law = law;
      u.few.options.rolling_friction = rolling;
      GrainSolver s = u.few.make({{0.3, 0.0, 0.3, u.a}, {0.3 + 0.86 * (a + b), 0.46 * (a + b), 0.302, u.b}});
      set_velocity(s, 0, {1.0, 0.3, 0.1});
      set_spin(s, 0, {30, -200, 100});
      set_spin(s, 1, {-70, 20, 150});
      const auto totals = [&] {
        Vec3 p = Vec3::Zero(), l = Vec3::Zero();
        for (const auto& [id, r] : {std::pair{0, u.a}, {1, u.b}}) {
          p += u.mass(r) * velocity(s, id);
          l += u.mass(r) * (position(s, id) - Vec3(0.3, 0, 0.3)).cross(velocity(s, id)) + u.inertia(r) * spin(s, id);
        }
        return std::pair(p, l);
      };
      const auto before = totals();
      for (int k = 0; k < 20000; ++k) s.step(1e-6);
      EXPECT_GT((spin(s, 0) - Vec3(30, -200, 100)).norm(), 1.0);
      const auto after = totals();
      // Round-off of positions (0.3 m) over 20000 steps: 20000 · 5e-17 m · m v = 2.5e-15 of equal spheres.
      EXPECT_LT((after.first - before.first).norm(), a == b ? 1e-15 : 3e-15) << law;
      EXPECT_LT((after.second - before.second).norm(), a == b ? 2.5e-15 : 5e-15) << law << rolling;
      EXPECT_GT(before.second.norm(), 1e-5);
    }
}

/// Two touching grains hold together up to F_c = π min(r)² c_t.
TEST(GrainSizes, pull_off_is_that_of_the_smaller) {
  Unequal u;
  u.few.options.cohesion = 80e3;
  u.few.options.restitution = 0.0;
  GrainSolver s = u.few.make({{0.3, 0.0, 0.3, u.a}, {0.3 + (u.a + u.b) * 0.9999, 0.0, 0.3, u.b}});
  s.set_drag(2000.0);
  for (int k = 0; k < 100000; ++k) s.step(1e-6);
  const double pull_off = std::numbers::pi * u.b * u.b * u.few.options.cohesion;
  const double e_star = 0.5 * u.few.options.young_modulus / (1.0 - std::pow(u.few.options.poisson_ratio, 2));
  const double overlap = std::pow(pull_off / (4.0 / 3.0 * e_star * std::sqrt(u.reduced_radius())), 2.0 / 3.0);
  const double distance = (position(s, 1) - position(s, 0)).norm();
  EXPECT_NEAR((u.a + u.b - distance) / overlap, 1.0, 1e-6);
}

FewGrains of_many_sizes() {
  FewGrains few;
  few.smallest = 0.0036, few.largest = 0.0084;
  few.options.size_spread = 0.4;
  few.options.length = 0.3, few.options.width = 0.24;
  return few;
}

FewGrains of_one_size() {
  FewGrains few = of_many_sizes();
  few.smallest = few.largest = few.options.size_spread = 0.0;
  return few;
}

GrainSolver crowd(const FewGrains& few, int n, double speed) {
  Uniform uniform(3);
  std::vector<Quad> out;
  for (int k = 0; k < n; ++k)
    out.push_back({0.02 + 0.0172 * (k % 16), -0.1 + 0.0172 * (k / 16 % 12), 0.0085 + 0.0172 * (k / 192),
                   0.006 * (1.0 + few.options.size_spread * uniform())});
  GrainSolver s = few.make(out);
  for (int id = 0; id < n; ++id) set_velocity(s, id, speed * Vec3(uniform(), uniform(), uniform()));
  s.reset_accounts();
  return s;
}

TEST(GrainSizes, crowd_keeps_momentum_and_books_its_energy) {
  FewGrains few = of_many_sizes();
  few.options.cohesion = 20e3;
  few.options.rolling_friction = 0.1;
  GrainSolver s = crowd(few, 1200, 0.6);
  expect_books_close(s, 5e-6, 3000, 1e-12);
  EXPECT_GT(s.accounts().contacts, 300);
  for (int g = 0; g < s.grains().count; ++g) ASSERT_GE(s.grains().position[g].w, few.smallest);
}

TEST(GrainSizes, frictionless_elastic_crowd_of_one_or_many_sizes_keeps_its_energy) {
  for (FewGrains few : {of_one_size(), of_many_sizes()}) {
    few.options.restitution = 1.0;
    few.options.friction = 0.0;
    GrainSolver s = crowd(few, 700, 0.5);
    const double k0 = s.accounts().kinetic;
    for (int k = 0; k < 6000; ++k) s.step(3e-6);
    EXPECT_NEAR(s.accounts().kinetic + s.accounts().elastic, k0, 2e-4 * k0);
  }
}

/// Stiffness or damping of a contact between a small grain and one `ratio` times as large, relative to the contact of
/// two small grains, in the small grain's fastest mode: k (1/m + 1/√(m M)) over 2 k/m, Gershgorin's bound in
/// mass-weighted coordinates.
double row_of_bound(double coefficient, double like, double ratio) {
  return coefficient / like * 0.5 * (1.0 + std::pow(ratio, -1.5));
}

TEST(GrainSizes, contacts_with_larger_grains_are_stiffer_and_yet_no_less_stable_than_those_with_their_like) {
  DemOptions o;
  const auto like = run_coefficients(o, o.step).pair.of<MindlinLaw>();
  for (double ratio = 1.0; ratio < 4.01; ratio += 0.05) {
    const auto c = MindlinLaw::scaled(like, pair_scale<double>(1.0, ratio));
    EXPECT_NEAR(c.stiffness / like.stiffness, std::sqrt(2.0 * ratio / (1.0 + ratio)), 1e-12);
    EXPECT_LE(row_of_bound(c.stiffness, like.stiffness, ratio), 1.0 + 1e-12) << ratio;
    EXPECT_LE(row_of_bound(c.shear_stiffness, like.shear_stiffness, ratio), 1.0 + 1e-12) << ratio;
    EXPECT_LE(row_of_bound(c.damping, like.damping, ratio), 1.013) << ratio;
  }
}

/// Growth of a small deviation from equilibrium over many steps, for a pair of cohesive grains with `ratio` between
/// their radii: the largest distance from rest over the initial one.
double growth_of_pair(double ratio, double share_of_limit) {
  FewGrains few;
  few.options.restitution = 0.999;
  few.options.cohesion = 80e3;
  few.smallest = few.options.radius, few.largest = ratio * few.options.radius * 1.0001;
  const double small = few.options.radius, large = ratio * small;
  const auto c = MindlinLaw::scaled(few.pair<MindlinLaw>(), pair_scale<double>(1.0, ratio));
  // K δ^{3/2} = F_c; about it ω² = 3/2 K √δ (1/m + 1/M).
  const double overlap = std::pow(c.cohesion_force / c.stiffness, 2.0 / 3.0);
  const double m = grain_properties(small, few.options.density).mass, big = m * ratio * ratio * ratio;
  const double omega = std::sqrt(1.5 * c.stiffness * std::sqrt(overlap) * (1.0 / m + 1.0 / big));
  const double rest = small + large - overlap, off = 1e-6 * overlap;
  GrainSolver s = few.make({{0.3, 0, 0.3, small}, {0.3 + rest + off, 0, 0.3, large}});
  double most = 0.0;
  for (int k = 0; k < 400; ++k) {
    s.step(share_of_limit * 2.0 / omega);
    most = std::max(most, std::abs((position(s, 1) - position(s, 0)).norm() - rest));
  }
  return most / off;
}

TEST(GrainSizes, pair_of_two_sizes_is_stable_up_to_its_closed_form_limit_which_lies_above_the_admitted_step) {
  double limit_of_like = 0.0;
  for (const double ratio : {1.0, 1.5, 2.5, 4.0}) {
    EXPECT_LT(growth_of_pair(ratio, 0.97), 50.0) << ratio;
    EXPECT_GT(growth_of_pair(ratio, 1.03), 1e3) << ratio;
    const double limit = std::pow(2.0 * ratio / (1.0 + ratio), -0.25) * std::sqrt(2.0 / (1.0 + std::pow(ratio, -3.0)));
    limit_of_like = std::max(limit_of_like, ratio == 1.0 ? limit : 0.0);
    EXPECT_GE(limit, limit_of_like) << ratio;
  }
}

TEST(GrainSizes, list_of_one_or_many_sizes_misses_no_contact) {
  for (FewGrains few : {of_one_size(), of_many_sizes()}) {
    few.gravity = kStandardGravity;
    GrainSolver s = crowd(few, 1200, 0.8);
    for (int round = 0; round < 10; ++round) {
      for (int k = 0; k < 60; ++k) s.step(1.5e-5);
      const auto& x = s.grains().position;
      std::int64_t contacts = 0;
      for (int i = 0; i < s.grains().count; ++i) {
        for (int j = i + 1; j < s.grains().count; ++j) contacts += (vec(x[i]) - vec(x[j])).norm() < x[i].w + x[j].w;
        for (int w = 0; w < kWalls; ++w) contacts += s.params().bin.distance(w, x[i]) < x[i].w;
      }
      s.step(1.5e-5);
      EXPECT_EQ(s.accounts().contacts, contacts);
    }
  }
}

TEST(GrainSizes, same_bits_for_any_threads_and_after_a_restart) {
  for (const Precision precision : {Precision::full, Precision::mixed}) {
    FewGrains few = of_many_sizes();
    few.precision = precision;
    few.options.rolling_friction = 0.1;
    few.gravity = kStandardGravity;
    expect_same_bits([&] { return crowd(few, 1200, 0.5); }, 1.5e-5, 500);
  }
}

/// The spread's mean volume, 1 + s² for uniform radii; and that the draw stays within the limits.
TEST(GrainSizes, drawn_radii_have_the_stated_mean_volume) {
  for (const char* distribution : {"uniform", "normal"}) {
    DemOptions o;
    o.size_spread = 0.5;
    o.size_distribution = distribution;
    std::vector<Quad> grains(200000);
    draw_radii(o, grains);
    double volume = 0.0;
    for (const Quad& p : grains) {
      ASSERT_GE(p.w, smallest_radius(o));
      ASSERT_LE(p.w, largest_radius(o));
      volume += std::pow(p.w / o.radius, 3) / static_cast<double>(grains.size());
    }
    EXPECT_NEAR(volume, mean_volume_ratio(o), 0.006) << distribution;
  }
  DemOptions uniform;
  uniform.size_spread = 0.5;
  EXPECT_NEAR(mean_volume_ratio(uniform), 1.25, 1e-15);
}

/// For uniform radii from a to b, the mass up to r is proportional to r⁴ − a⁴, so the median is ((a⁴ + b⁴)/2)^¼.
TEST(GrainSizes, median_by_mass_is_that_of_the_drawn_grains) {
  for (const char* distribution : {"uniform", "normal"}) {
    DemOptions o;
    o.size_spread = 0.5;
    o.size_distribution = distribution;
    std::vector<Quad> grains(20000);
    draw_radii(o, grains);
    for (std::size_t k = 0; k < grains.size(); ++k) grains[k].x = 0.1 * static_cast<double>(k);
    const Bin bin{2001.0, 1.0, false, false};
    EXPECT_NEAR(bed_statistics(grains, bin, 50.0).median_by_mass / median_radius_by_mass(o), 1.0, 0.01) << distribution;
    EXPECT_GT(median_radius_by_mass(o), 1.05 * o.radius);
  }
  DemOptions uniform;
  uniform.size_spread = 0.5;
  const double a = smallest_radius(uniform), b = largest_radius(uniform);
  EXPECT_NEAR(median_radius_by_mass(uniform) / std::pow(0.5 * (std::pow(a, 4) + std::pow(b, 4)), 0.25), 1.0, 1e-6);
  uniform.size_spread = 0.0;
  EXPECT_NEAR(median_radius_by_mass(uniform), uniform.radius, 1e-15);
}

TEST(GrainSizes, sizes_that_cannot_be_are_refused_with_their_key) {
  DemOptions wide, other_law, gamma;
  wide.size_spread = 0.7;
  other_law.size_spread = 0.3, other_law.law = "hertz_tanh";
  gamma.size_distribution = "gamma";
  for (const auto& [options, words] : {std::pair(wide, "size_spread': is 0.7, expected a number, 0 to 0.6"),
                                       {other_law, "expected law 'mindlin'"},
                                       {gamma, "expected 'uniform' or 'normal'"}})
    expect_refused(ExitCode::bad_input, {words}, [&] { make_dem_terrain(options); });
}

/// The floor carries the weight, which follows from the volumes; solid fraction is that of a random packing.
TEST(GrainSizes, bed_of_many_sizes_settles) {
  DemOptions o;
  o.size_spread = 0.4;
  o.length = 0.2, o.width = 0.15, o.layers = 8;
  o.cache = false;
  o.step = 1e-5;
  const PreparedBed prepared = prepare_bed(o, {});
  EXPECT_TRUE(prepared.settled.settled);
  GrainSolver s(solver_params(o));
  s.restore(prepared.bed);
  const std::vector<Quad> grains(s.grains().position.begin(), s.grains().position.begin() + s.grains().count);
  const BedStatistics b = bed_statistics(grains, s.params().bin, o.radius);
  EXPECT_NEAR(b.grain_volume * o.density, s.params().grain.mass * s.relative_mass(), 1e-12);
  const double weight = b.grain_volume * o.density * kStandardGravity;
  EXPECT_NEAR(s.accounts().floor_force, weight, kSettledFloorError * weight);
  EXPECT_GT(b.solid_fraction_bulk, 0.53);
  EXPECT_LT(b.solid_fraction_bulk, 0.66);
}

}  // namespace
}  // namespace furrow::terrain::dem
