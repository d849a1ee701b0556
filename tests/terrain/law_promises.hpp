// Properties of every contact law: tests over a list of laws. A law is tested once it is in the list. Each law is tried
// in the same random contacts, stiff enough to press and slide.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <tuple>
#include <type_traits>
#include <vector>

#include "protocol/core/simd.hpp"
#include "terrain/dem/contact/contact_mixing.hpp"

namespace furrow::terrain::dem::testing {

template <class T>
constexpr bool same_bits(const T& a, const T& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

/// A contact in some state, in double.
struct Contact {
  ContactMotion<double> motion;
  ContactHistory<double> history;
};

class Contacts {
 public:
  Contact operator()() {
    Contact c;
    const Triple<double> n = draw(1.0);
    c.motion.normal = (1.0 / std::sqrt(dot(n, n))) * n;
    c.motion.overlap = 3e-4 * (1.1 + draw());
    c.motion.root_overlap = std::sqrt(c.motion.overlap);
    c.motion.velocity = draw(0.3);
    c.motion.spin = 20.0 * draw();
    c.motion.roll = draw(40.0);
    c.history = {in_plane(draw(3.0), c), c.motion.root_overlap * (1.0 + 0.2 * draw()), in_plane(draw(1e-3), c)};
    return c;
  }
  double draw() { return std::uniform_real_distribution<double>(-1.0, 1.0)(bits_); }

 private:
  Triple<double> draw(double size) { return {size * draw(), size * draw(), size * draw()}; }
  static Triple<double> in_plane(const Triple<double>& v, const Contact& c) {
    return v - dot(v, c.motion.normal) * c.motion.normal;
  }
  std::mt19937_64 bits_{5};
};

inline constexpr double kStep = 1e-6;  // s
inline constexpr int kContacts = 200;

/// Coefficients of `Law` for a grain on another, with rolling resistance and cohesion.
template <class Law>
typename Law::template Coefficients<double> coefficients_of(const ContactMaterial& a, const ContactMaterial& b) {
  DemOptions options;
  options.rolling_friction = 0.1;
  options.step = kStep;
  const GrainProperties grain = grain_properties(options.radius, options.density);
  const MixedPair pair{.a = a,
                       .b = b,
                       .radius = grain.radius,
                       .reduced_radius = 0.5 * grain.radius,
                       .mass = 0.5 * grain.mass,
                       .slide_mass = grain.mass / 7.0,
                       .inertia = 0.5 * grain.inertia,
                       .friction = std::min(a.friction, b.friction),
                       .rolling = options.rolling_friction};
  return Law::mix(pair, options);
}
template <class Law>
typename Law::template Coefficients<double> coefficients_of() {
  DemOptions options;
  options.cohesion = 20e3;
  return coefficients_of<Law>(grain_material(options), grain_material(options));
}

template <class T>
Triple<T> wide(const Triple<double>& v) {
  return {constant<T>(v.x), constant<T>(v.y), constant<T>(v.z)};
}
template <class T>
ContactMotion<T> wide(const ContactMotion<double>& m) {
  return {wide<T>(m.normal),   constant<T>(m.overlap), constant<T>(m.root_overlap),
          wide<T>(m.velocity), constant<T>(m.spin),    wide<T>(m.roll)};
}
template <class T>
ContactHistory<T> wide(const ContactHistory<double>& h) {
  return {wide<T>(h.tangential), constant<T>(h.root_overlap), wide<T>(h.rolling)};
}

/// Force and history after a step, as numbers.
template <class Law, class T>
std::vector<T> evaluated(const Contact& at) {
  const auto c = ContactCoefficients(coefficients_of<Law>()).of<Law, RealOf<T>>();
  ContactHistory<T> h = wide<T>(at.history);
  const ContactForce<T> f = Law::template force<true>(c, static_cast<RealOf<T>>(kStep), wide<T>(at.motion), h);
  std::vector<T> out{f.normal, f.elastic, f.energy, h.root_overlap};
  for (const Triple<T>& v : {f.tangential, f.rolling, h.tangential, h.rolling}) out.insert(out.end(), {v.x, v.y, v.z});
  return out;
}

template <class Law>
class LawPromises : public ::testing::Test {};
TYPED_TEST_SUITE_P(LawPromises);

TYPED_TEST_P(LawPromises, force_is_exactly_odd_under_exchange_of_the_grains) {
  using Law = TypeParam;
  const auto c = coefficients_of<Law>();
  const auto turned = [](const Triple<double>& v) { return Triple<double>{-v.x, -v.y, -v.z}; };
  Contacts draw;
  for (int k = 0; k < kContacts; ++k) {
    const Contact one = draw();
    Contact other = one;
    for (auto* v : {&other.motion.normal, &other.motion.velocity, &other.motion.roll, &other.history.tangential,
                    &other.history.rolling})
      *v = turned(*v);
    other.motion.spin = -one.motion.spin;
    ContactHistory<double> a = one.history, b = other.history;
    const auto f = Law::template force<true>(c, kStep, one.motion, a);
    const auto g = Law::template force<true>(c, kStep, other.motion, b);
    EXPECT_EQ(f.normal, g.normal);
    EXPECT_EQ(f.energy, g.energy);
    EXPECT_TRUE(same_bits(f.tangential, turned(g.tangential)));
    EXPECT_TRUE(same_bits(f.rolling, turned(g.rolling)));
    EXPECT_TRUE(same_bits(a.tangential, turned(b.tangential)));
    EXPECT_TRUE(same_bits(a.rolling, turned(b.rolling)));
    EXPECT_EQ(a.root_overlap, b.root_overlap);
  }
}

TYPED_TEST_P(LawPromises, mixing_and_sizes_are_symmetric_to_the_last_bit) {
  using Law = TypeParam;
  std::mt19937_64 bits(3);
  const auto draw = [&](double lo, double hi) { return std::uniform_real_distribution<double>(lo, hi)(bits); };
  const auto material = [&] {
    return ContactMaterial{draw(1e6, 1e9), draw(0.0, 0.49), draw(0.0, 1.0), draw(0.0, 1.0),
                           draw(1e5, 1e7), draw(0.0, 99.0), draw(0.0, 1e5), 0.0};
  };
  for (int k = 0; k < kContacts; ++k) {
    const ContactMaterial a = material(), b = material();
    const auto c = coefficients_of<Law>(a, b);
    EXPECT_TRUE(same_bits(c, coefficients_of<Law>(b, a)));
    if constexpr (Law::kSizes) {
      const double r = draw(0.4, 1.6), s = draw(0.4, 1.6);
      EXPECT_TRUE(same_bits(Law::scaled(c, pair_scale(r, s)), Law::scaled(c, pair_scale(s, r))));
      EXPECT_TRUE(same_bits(Law::scaled(c, pair_scale(1.0, 1.0)), c));
      EXPECT_TRUE(same_bits(Law::scaled(c, surface_scale(1.0, 0.0)), c));
    }
  }
}

/// The work of slow pressing, by Simpson's rule over √δ, in which Hertz's force is smooth.
TYPED_TEST_P(LawPromises, energy_is_the_work_of_the_normal_force_at_rest) {
  using Law = TypeParam;
  const auto c = coefficients_of<Law>();
  const auto at = [&](double root_overlap) {
    ContactHistory<double> h{};
    ContactMotion<double> m{{1, 0, 0}, root_overlap * root_overlap, root_overlap, {0, 0, 0}, 0.0, {0, 0, 0}};
    return Law::template force<false>(c, kStep, m, h);
  };
  constexpr int kParts = 64;
  const double end = 0.02, part = end / kParts;
  double work = 0.0;
  for (int k = 0; k <= kParts; ++k) {
    const double weight = k == 0 || k == kParts ? 1.0 : k % 2 == 1 ? 4.0 : 2.0, s = k * part;
    work += weight * part / 3.0 * at(s).normal * 2.0 * s;
  }
  const ContactForce<double> f = at(end);
  EXPECT_NEAR(work / f.energy, 1.0, 1e-6);
  EXPECT_NEAR(Law::resting_force(c, end * end) / f.normal, 1.0, 1e-12);
  EXPECT_NEAR(Law::resting_overlap(c, f.normal) / (end * end), 1.0, 1e-12);
}

/// Along smooth paths, from the first touch to the parting and through reversals.
TYPED_TEST_P(LawPromises, no_mechanism_gains_energy_on_a_path_and_the_books_close) {
  using Law = TypeParam;
  const auto c = coefficients_of<Law>();
  Contacts draw;
  for (int path = 0; path < 20; ++path) {
    const double swing = 0.2 + 0.1 * draw.draw(), slide = 1e-4 * (1.0 + draw.draw()), roll = 0.05 * draw.draw();
    constexpr int kSteps = 40000;
    ContactHistory<double> h{};
    Losses lost;
    double work = 0.0;
    for (int k = 0; k < kSteps; ++k) {
      const double t = (k + 0.5) / kSteps, turn = 2.0 * M_PI / (kSteps * kStep);
      const auto arc = [&](double n) {
        return std::pair(std::sin(n * M_PI * t), 0.5 * n * turn * std::cos(n * M_PI * t));
      };
      const auto [depth, sinking] = arc(1.0);
      const auto [wave, waving] = arc(6.0);
      ContactMotion<double> m;
      m.normal = {0, 0, 1};
      m.overlap = 4e-4 * (depth * (1.0 + swing * wave) + 1e-9);
      m.root_overlap = std::sqrt(m.overlap);
      m.velocity = {slide * arc(3.0).second, -slide * arc(4.0).second,
                    -4e-4 * (sinking * (1.0 + swing * wave) + depth * swing * waving)};
      m.spin = 0.0;
      m.roll = {roll * arc(3.0).second, roll * arc(5.0).second, 0.0};
      const ContactSample s = sample_of<Law, true>(c, kStep, m, h);
      const ContactForce<double> f = Law::template force<true>(c, kStep, m, h);
      ASSERT_GE(s.power.normal_damping, 0.0) << k;
      add(lost, s.power, kStep);
      work -= kStep * (power_of(f, m) + dot(f.rolling, m.roll));
      const double held = Law::held(c, m.overlap, h).tangential;
      ASSERT_NEAR(s.stored.tangential, held, 1e-9 * held + 1e-18);
    }
    lost.opening += Law::held(c, 0.0, h).tangential;
    EXPECT_GT(total(lost), 0.0);
    for (const double loss : {lost.sliding, lost.tangential_damping, lost.rolling}) EXPECT_GE(loss, 0.0) << path;
    EXPECT_NEAR(work / total(lost), 1.0, 0.02) << path;
  }
}

/// A contact that sticks, or creeps slowly, without memory of before.
TYPED_TEST_P(LawPromises, tangent_is_the_difference_of_the_force) {
  using Law = TypeParam;
  const auto c = coefficients_of<Law>();
  const double root_overlap = 0.017, share = 0.7, speed = 1e-7, step = 1e-9;
  const auto at = [&](double deeper, const Triple<double>& v, double dt) {
    const double overlap = root_overlap * root_overlap + deeper;
    ContactHistory<double> h{{0, 0, 0}, root_overlap, {0, 0, 0}};
    const ContactMotion<double> m{{1, 0, 0}, overlap, std::sqrt(overlap), v, 0.0, {0, 0, 0}};
    return std::pair(Law::template force<false>(c, dt, m, h), m);
  };
  const auto [rest, here] = at(0.0, {0, 0, 0}, step);
  const ContactStiffness t = Law::tangent(c, here, rest, share);
  const double deep = 1e-9;
  EXPECT_NEAR(share * (at(deep, {0, 0, 0}, step).first.normal - at(-deep, {0, 0, 0}, step).first.normal) / (2.0 * deep),
              t.k_n, 1e-4 * t.k_n);
  EXPECT_NEAR(-share * (at(0.0, {speed, 0, 0}, step).first.normal - rest.normal) / speed, t.c_n, 1e-4 * t.c_n + 1e-9);
  // Over a step dt the displacement is v dt: a dashpot's force remains as dt → 0, and a spring adds to it.
  const double shortly = -share * at(0.0, {0, speed, 0}, 0.0).first.tangential.y / speed;
  const double longer = -share * at(0.0, {0, speed, 0}, 1e-3).first.tangential.y / speed;
  EXPECT_NEAR(shortly, t.c_t, 1e-4 * t.c_t + 1e-9);
  EXPECT_NEAR((longer - shortly) / 1e-3, t.k_t, 1e-4 * t.k_t + 1e-6);
}

TYPED_TEST_P(LawPromises, one_double_has_the_bits_of_four_and_floats_are_near) {
  using Law = TypeParam;
  Contacts draw;
  for (int k = 0; k < kContacts; ++k) {
    const Contact one = draw();
    const std::vector<double> exact = evaluated<Law, double>(one);
    const std::vector<Double4> four = evaluated<Law, Double4>(one);
    const std::vector<float> single = evaluated<Law, float>(one);
    const std::vector<Float8> eight = evaluated<Law, Float8>(one);
    double size = 0.0;
    for (std::size_t n = 0; n < exact.size(); ++n) size = std::max(size, std::abs(exact[n]));
    for (std::size_t n = 0; n < exact.size(); ++n) {
      EXPECT_EQ(four[n][k % 4], exact[n]) << n;
      EXPECT_EQ(eight[n][k % 8], single[n]) << n;
      EXPECT_NEAR(single[n], exact[n], 1e-5 * size) << n;
    }
  }
}

TYPED_TEST_P(LawPromises, its_stiffness_and_step_are_finite_and_positive) {
  using Law = TypeParam;
  const auto c = coefficients_of<Law>();
  const GrainProperties grain = grain_properties(0.006, 2500.0);
  const StableStep stable = Law::stable_step(c, DemOptions{}, grain.mass, 1e-4);
  EXPECT_GT(stable.step, 1e-7);
  EXPECT_LT(stable.step, 1e-2);
  EXPECT_GT(Law::young_modulus(DemOptions{}), 0.0);
}

REGISTER_TYPED_TEST_SUITE_P(LawPromises, force_is_exactly_odd_under_exchange_of_the_grains,
                            mixing_and_sizes_are_symmetric_to_the_last_bit,
                            energy_is_the_work_of_the_normal_force_at_rest,
                            no_mechanism_gains_energy_on_a_path_and_the_books_close,
                            tangent_is_the_difference_of_the_force, one_double_has_the_bits_of_four_and_floats_are_near,
                            its_stiffness_and_step_are_finite_and_positive);

/// The types of a table.
template <class Table>
struct TypesOf;
template <class... Law>
struct TypesOf<std::tuple<Law...>> {
  using type = ::testing::Types<Law...>;
};
struct NameOfLaw {
  template <class Law>
  static std::string GetName(int) {
    return Law::kName;
  }
};

}  // namespace furrow::terrain::dem::testing
