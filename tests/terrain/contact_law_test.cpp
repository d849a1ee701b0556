// The contact laws against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/protocol/fields_of.hpp"
#include "tests/terrain/few_grains.hpp"

namespace furrow::terrain::dem {
namespace {

constexpr double kPi = std::numbers::pi;

ContactMotion<double> touching(double overlap, const Triple<double>& v = {0, 0, 0}) {
  return {{1, 0, 0}, overlap, std::sqrt(overlap), v, 0.0, {0, 0, 0}};
}

TEST(Lanes, tanh_agrees_with_the_standard_library) {
  for (double x : {0.0, 1e-12, 1e-6, 1e-3, 0.1, 0.17, 0.18, 0.5, 1.0, 3.0, 7.0, 19.0, 100.0}) {
    EXPECT_NEAR(tanh_of_positive(x), std::tanh(x), 4e-16) << x;
    EXPECT_EQ(tanh_of_positive(constant<Double4>(x))[2], tanh_of_positive(x)) << x;
    const double scale = x > 0.0 ? 1.0 / std::tanh(x) : 0.0;
    EXPECT_NEAR(tanh_of_positive(x) * scale, std::tanh(x) * scale, 1e-14) << x;
  }
}

TEST(Lanes, tanh_of_one_float_agrees_with_the_standard_library_and_with_eight_floats) {
  for (const float x : {0.0f, 1e-6f, 1e-3f, 0.1f, 0.5f, 1.0f, 3.0f, 9.0f, 50.0f}) {
    EXPECT_NEAR(tanh_of_positive(x), std::tanh(x), 2e-7f) << x;
    EXPECT_EQ(tanh_of_positive(constant<Float8>(x))[5], tanh_of_positive(x)) << x;
  }
}

TEST(Accounts, the_list_of_fields_forgets_no_member) {
  using testing::member_count, testing::names_of;
  EXPECT_EQ(names_of<Accounts>().size(), member_count<Accounts>());
  EXPECT_EQ(names_of<Quad>().size(), member_count<Quad>());
  EXPECT_EQ(names_of<WallContact>().size(), member_count<WallContact>());
  EXPECT_EQ(names_of<SurfaceHistory>().size(), member_count<SurfaceHistory>());
}

TEST(MindlinLaw, hertz_force_matches_johnson_1985_eq_4_23) {
  FewGrains few;
  const auto pair_of = few.pair<MindlinLaw>(), wall_of = few.floor<MindlinLaw>();
  const double e_star = few.options.young_modulus / (2.0 * (1.0 - 0.09)), delta = 3e-4;
  ContactHistory<double> history{};
  const auto pair = MindlinLaw::force<false>(pair_of, 1e-6, touching(delta), history);
  EXPECT_NEAR(pair.normal, 4.0 / 3.0 * e_star * std::sqrt(0.003) * std::pow(delta, 1.5), 1e-12);
  const auto wall = MindlinLaw::force<false>(wall_of, 1e-6, touching(delta), history);
  EXPECT_NEAR(wall.normal, 4.0 / 3.0 * e_star * std::sqrt(0.006) * std::pow(delta, 1.5), 1e-12);
  EXPECT_NEAR(pair_of.stiffness, 1e6, 1e4);  // the report's k_n is E = 2.49e7 Pa at r = 6 mm
}

TEST(MindlinLaw, tangential_stiffness_matches_mindlin_1949) {
  FewGrains few;
  const double g = few.options.young_modulus / 2.6, delta = 3e-4;
  const double g_star = g / (2.0 * (2.0 - 0.3)), contact_radius = std::sqrt(0.003 * delta);
  ContactHistory<double> history{};
  auto undamped = few.pair<MindlinLaw>();
  undamped.damping = undamped.shear_damping = 0.0;
  const double v = 1e-4, dt = 1e-5;
  ContactForce<double> f{};
  for (int k = 0; k < 10; ++k) f = MindlinLaw::force<false>(undamped, dt, touching(delta, {0, v, 0}), history);
  EXPECT_NEAR(f.tangential.y, -8.0 * g_star * contact_radius * 10 * v * dt, 1e-12);
}

TEST(MindlinLaw, sliding_is_cut_at_coulomb_of_the_force_before_cohesion) {
  FewGrains few;
  few.options.cohesion = 80e3;
  const auto c = few.pair<MindlinLaw>();
  ContactHistory<double> history{};
  const double delta = std::pow(c.cohesion_force / c.stiffness, 2.0 / 3.0);  // no net load
  ContactForce<double> f{};
  for (int k = 0; k < 1000; ++k) f = MindlinLaw::force<false>(c, 1e-5, touching(delta, {0, 0.3, 0.4}), history);
  EXPECT_NEAR(f.normal, 0.0, 1e-9);
  EXPECT_NEAR(std::hypot(f.tangential.y, f.tangential.z), 0.9 * c.cohesion_force, 1e-9);
  EXPECT_NEAR(c.cohesion_force, 9.048, 1e-3);
}

TEST(MindlinLaw, tangential_spring_is_rescaled_on_unloading) {
  FewGrains few;
  const auto c = few.pair<MindlinLaw>();
  ContactHistory<double> history{{0, 1.0, 0}, std::sqrt(4e-4), {0, 0, 0}};
  const auto f = MindlinLaw::force<false>(c, 1e-6, touching(1e-4), history);
  EXPECT_NEAR(f.tangential.y, 0.5, 1e-14);  // √(δ/δ_old) = ½
  const auto back = MindlinLaw::force<false>(c, 1e-6, touching(4e-4), history);
  EXPECT_NEAR(back.tangential.y, 0.5, 1e-14);
}

TEST(MindlinLaw, history_turns_with_normal_and_spin) {
  ContactHistory<double> history{{0, 1.0, 0}, 0.02, {0, 0, 0}};
  const double a = 1e-3;
  const Triple<double> n{std::cos(a), std::sin(a), 0.0};
  const auto turned = turn_with_contact(history.tangential, n, 0.0, 1.0);
  EXPECT_NEAR(turned.x, -std::sin(a), 1e-15);
  EXPECT_NEAR(turned.y, std::cos(a), 1e-15);
  Triple<double> t{0, 1, 0};
  for (int k = 0; k < 1000; ++k) t = turn_with_contact(t, {1, 0, 0}, 0.5 * kPi / 1000, 1.0);
  EXPECT_NEAR(t.z, 1.0, 1e-6);  // a quarter turn about x takes y to z
  EXPECT_NEAR(std::hypot(t.y, t.z), 1.0, 1e-12);
}

TEST(HertzTanhLaw, force_is_the_reports) {
  FewGrains few;
  few.options.law = "hertz_tanh";
  few.options.friction_impulse_limit = false;
  few.options.cohesion = 80e3;
  const auto c = few.pair<HertzTanhLaw>();
  ContactHistory<double> history{};
  const double delta = 4e-4, v_n = 0.02, v_t = 0.1;
  const auto f = HertzTanhLaw::force<false>(c, 1e-6, touching(delta, {v_n, 0, v_t}), history);
  const double elastic = std::sqrt(delta) * (1e6 * delta - 60.0 * v_n);
  EXPECT_NEAR(f.normal, elastic - kPi * 36e-6 * 80e3, 1e-12);
  EXPECT_NEAR(f.tangential.z, -0.9 * elastic * std::tanh(0.5), 1e-12);
  EXPECT_EQ(HertzTanhLaw::force<false>(c, 1e-6, touching(1e-6, {10.0, 0, 0}), history).elastic, 0.0);
}

TEST(HertzTanhLaw, impulse_limit_caps_friction_at_three_tenths) {
  FewGrains few;
  few.options.law = "hertz_tanh";
  few.options.step = 4e-5;
  const double m = grain_properties(0.006, 2500).mass;
  ContactHistory<double> history{};
  const double v_t = 1e-4;
  const auto pair = HertzTanhLaw::force<false>(few.pair<HertzTanhLaw>(), 4e-5, touching(4.34e-4, {0, v_t, 0}), history);
  EXPECT_NEAR(pair.tangential.y, -0.3 * m / 7.0 * v_t / 4e-5, 1e-15);
  const auto wall =
      HertzTanhLaw::force<false>(few.floor<HertzTanhLaw>(), 4e-5, touching(4.34e-4, {0, v_t, 0}), history);
  EXPECT_NEAR(wall.tangential.y, -0.3 * 2.0 * m / 7.0 * v_t / 4e-5, 1e-15);
}

TEST(Mixing, follows_the_stated_rules) {
  FewGrains few;
  few.options.law = "hertz_tanh";
  few.options.cohesion = 80e3;
  ContactMaterial tire{2e7, 0.4, 0.8, 0.1, 2e6, 13.0, 0.0};
  const GrainProperties grain = grain_properties(0.006, 2500);
  const auto mixed = [&] { return mix(grain_material(few.options), tire, Partner::surface, grain, few.options); };
  const auto by_report = mixed().of<HertzTanhLaw>();
  EXPECT_DOUBLE_EQ(by_report.stiffness, 1.5e6);
  EXPECT_DOUBLE_EQ(by_report.damping, 36.5);
  EXPECT_DOUBLE_EQ(by_report.friction, 0.8);
  EXPECT_EQ(by_report.cohesion_force, 0.0);
  few.options.law = "mindlin";
  auto c = mixed().of<MindlinLaw>();
  const double e_star = 1.0 / ((1 - 0.09) / 2.49e7 + (1 - 0.16) / 2e7);
  EXPECT_NEAR(c.stiffness, 4.0 / 3.0 * e_star * std::sqrt(0.006), 1e-6);
  // A tire of 4.2 kg/m² moves with 0.52 g under a grain of 2.26 g: its damper is that of the lighter pair.
  const double heavy = c.damping, heavy_shear = c.shear_damping, skin = 4.2 * 2.0 * std::sqrt(3.0) * 0.006 * 0.006;
  tire.area_density = 4.2;
  c = mixed().of<MindlinLaw>();
  EXPECT_NEAR(c.damping / heavy, std::sqrt(skin / (skin + grain.mass)), 1e-12);
  EXPECT_NEAR(c.shear_damping / heavy_shear, std::sqrt(skin / (skin + grain.mass / 3.5)), 1e-12);
}

TEST(StableStep, names_what_limits_it) {
  FewGrains few;
  const GrainProperties grain = grain_properties(0.006, 2500);
  const StableStep mindlin = stable_step(few.coefficients().pair, grain, few.options, 6e-4);
  EXPECT_GT(mindlin.step, 4e-5);
  EXPECT_LT(mindlin.step, 1.5e-4);
  few.options.law = "hertz_tanh";
  few.options.friction_impulse_limit = false;
  few.options.cohesion = 80e3;
  const StableStep report = stable_step(few.coefficients().pair, grain, few.options, 4.342e-4);
  EXPECT_STREQ(report.reason, "friction viscosity");
  // 7 c μ F dt/m = 5 at F = 9 N and 4e-5 s; stable below 2.
  EXPECT_NEAR(report.step, 2.0 / 5.0 * 4e-5, 0.02 * 1.6e-5);
}

}  // namespace
}  // namespace furrow::terrain::dem
