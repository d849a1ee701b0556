// Explicit integration of planar triangles: conserved quantities, order, and the largest step.
#include "tests/tire/planar/planar_motion.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "tests/tire/planar/planar_examples.hpp"

namespace furrow::tire {
namespace {

constexpr PlanarIntegrator kBoth[] = {PlanarIntegrator::semi_implicit_euler, PlanarIntegrator::runge_kutta_4};

/// A wheel that spins, flies and trembles.
PlanarState thrown(const PlanarMesh& mesh, double tremble = 0.3) {
  PlanarState s{mesh.position, random_planar(mesh.position.size(), tremble, 11)};
  for (std::size_t n = 0; n < s.x.size(); ++n) s.v.x[n] += 3.0 + 8.0 * s.x.z[n], s.v.z[n] += 1.0 - 8.0 * s.x.x[n];
  return s;
}

struct Momenta {
  double x = 0.0, z = 0.0, spin = 0.0;
};

Momenta momenta(const PlanarMotion& motion) {
  Momenta m;
  const PlanarState& s = motion.state();
  for (std::size_t n = 0; n < s.x.size(); ++n) {
    m.x += motion.mass()[n] * s.v.x[n], m.z += motion.mass()[n] * s.v.z[n];
    m.spin += motion.mass()[n] * (s.x.z[n] * s.v.x[n] - s.x.x[n] * s.v.z[n]);
  }
  return m;
}

TEST(PlanarMotion, momentum_and_angular_momentum_stay_to_round_off_of_euler_and_the_order_of_runge_kutta) {
  const PlanarMesh mesh = small_wheel();
  for (const bool averaged : {false, true})
    for (const PlanarIntegrator kind : kBoth) {
      PlanarMotion motion(wheel_elements(mesh, {.averaged = averaged}, 100.0), thrown(mesh), kind);
      const double h = 0.4 * step_limit(motion.elements(), mesh.position);
      const Momenta before = momenta(motion);
      for (int k = 0; k < 300; ++k) ASSERT_TRUE(motion.step(h));
      const Momenta after = momenta(motion);
      EXPECT_NEAR(after.x, before.x, 1e-11 * before.x);
      EXPECT_NEAR(after.z, before.z, 1e-11 * before.x);
      const double share = kind == PlanarIntegrator::semi_implicit_euler ? 1e-11 : 1e-6;
      EXPECT_NEAR(after.spin, before.spin, share * std::abs(before.spin));
    }
}

TEST(PlanarMotion, energy_is_kept_without_viscosity_and_falls_with_it) {
  const PlanarMesh mesh = small_wheel();
  const auto total = [](const PlanarMotion& m) { return m.kinetic_energy() + m.elements().energy(m.state().x); };
  const auto largest_change = [&](PlanarIntegrator kind, double share) {
    PlanarMotion motion(wheel_elements(mesh), thrown(mesh), kind);
    const double limit = step_limit(motion.elements(), mesh.position), begin = total(motion);
    double most = 0.0;
    for (int k = 0; k < static_cast<int>(200 / share); ++k) {
      EXPECT_TRUE(motion.step(share * limit));
      most = std::max(most, std::abs(total(motion) - begin));
    }
    return most / begin;
  };
  // Euler's energy oscillates in proportion to the step, without drift; Runge–Kutta's falls with its fifth power.
  const double coarse = largest_change(kBoth[0], 0.2), fine = largest_change(kBoth[0], 0.1);
  EXPECT_LT(coarse, 0.02);
  EXPECT_LT(fine, 0.6 * coarse);
  EXPECT_LT(largest_change(kBoth[1], 0.2), 1e-4);
  EXPECT_LT(largest_change(kBoth[1], 0.1), largest_change(kBoth[1], 0.2) / 20.0);
  PlanarMotion motion(wheel_elements(mesh, {}, 200.0), thrown(mesh), kBoth[1]);
  const double h = 0.1 * step_limit(motion.elements(), mesh.position);
  double before = total(motion);
  for (int k = 0; k < 50; ++k) {
    const double power = motion.elements().viscous_power(motion.state().x, motion.state().v);
    ASSERT_TRUE(motion.step(h));
    const double now = total(motion), later = motion.elements().viscous_power(motion.state().x, motion.state().v);
    EXPECT_NEAR(before - now, 0.5 * h * (power + later), 0.05 * h * (power + later));
    before = now;
  }
}

/// Largest ω² of the assembled mesh, all nodes free.
double fastest(const PlanarElements& elements, const PlanarField& x) {
  Eigen::MatrixXd k = assembled(elements, x);
  Eigen::VectorXd root(k.rows());
  for (int n = 0; n < elements.nodes(); ++n) root[2 * n] = root[2 * n + 1] = 1.0 / std::sqrt(elements.mass()[n]);
  k = root.asDiagonal() * k * root.asDiagonal();
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(k, Eigen::EigenvaluesOnly).eigenvalues()[k.rows() - 1];
}

TEST(PlanarMotion, the_step_limit_is_that_of_the_fastest_mode_or_a_little_less) {
  for (const bool averaged : {false, true}) {
    const PlanarMesh mesh = small_wheel(18, 3);
    const PlanarElements elements = wheel_elements(mesh, {.averaged = averaged});
    const double limit = step_limit(elements, mesh.position), exact = 2.0 / std::sqrt(fastest(elements, mesh.position));
    EXPECT_LE(limit, exact * (1 + 1e-12));
    EXPECT_GT(limit, (averaged ? 0.4 : 0.6) * exact);
    for (const double share : {0.99, 1.01}) {  // of the exact one
      PlanarState start{mesh.position, random_planar(mesh.position.size(), 1e-7, 2)};
      PlanarMotion motion(elements, start);
      const double begin = motion.kinetic_energy();
      for (int k = 0; k < 2000 && motion.kinetic_energy() < 1e6 * begin; ++k)
        if (!motion.step(share * exact)) break;
      EXPECT_EQ(motion.kinetic_energy() < 1e4 * begin, share < 1.0) << share << " " << averaged;
    }
  }
}

TEST(PlanarMotion, the_limit_of_one_triangle_is_exact_with_viscosity_and_when_pressed) {
  PlanarMesh mesh;
  mesh.position.x = {0.0, 0.04, 0.01}, mesh.position.z = {0.0, 0.0, 0.03};
  mesh.triangles = {{0, 1, 2}}, mesh.part = {0};
  PlanarMaterial material = kRubber;
  const PlanarElements elastic(mesh, std::array{material}, {});
  EXPECT_NEAR(step_limit(elastic, mesh.position), 2.0 / std::sqrt(fastest(elastic, mesh.position)), 1e-12);
  const PlanarField pressed = mapped(mesh.position, Eigen::Matrix2d(Eigen::Vector2d(1.0, 0.4).asDiagonal()));
  EXPECT_LT(step_limit(elastic, pressed), 0.8 * step_limit(elastic, mesh.position));
  EXPECT_NEAR(step_limit(elastic, pressed), 2.0 / std::sqrt(fastest(elastic, pressed)), 1e-12);
  for (const double viscosity : {30.0, 3000.0}) {
    material.viscosity = viscosity;
    const PlanarElements damped(mesh, std::array{material}, {});
    const double limit = step_limit(damped, mesh.position);
    EXPECT_LT(limit, step_limit(elastic, mesh.position));
    for (const PlanarIntegrator kind : kBoth) {  // the Runge–Kutta method is stable at it, too
      PlanarMotion motion(damped, {mesh.position, random_planar(3, 1e-6, 2)}, kind);
      const double begin = motion.kinetic_energy();
      for (int k = 0; k < 500; ++k) ASSERT_TRUE(motion.step(0.99 * limit));
      EXPECT_LT(motion.kinetic_energy(), 10.0 * begin);
    }
    PlanarMotion motion(damped, {mesh.position, random_planar(3, 1e-6, 2)});
    const double begin = motion.kinetic_energy();
    for (int k = 0; k < 3000 && motion.kinetic_energy() < 1e6 * begin; ++k)
      if (!motion.step(1.4 * limit)) break;
    EXPECT_GE(motion.kinetic_energy(), 1e4 * begin);
  }
}

TEST(PlanarMotion, runge_kutta_is_of_fourth_order_and_euler_of_first) {
  const PlanarMesh mesh = small_wheel(12, 2);
  const double limit = step_limit(wheel_elements(mesh), mesh.position), end = 8.0 * limit;
  const auto state = [&](PlanarIntegrator kind, int steps) {
    PlanarMotion motion(wheel_elements(mesh, {}, 20.0), thrown(mesh), kind);
    for (int k = 0; k < steps; ++k) EXPECT_TRUE(motion.step(end / steps));
    return motion.state().x;
  };
  const PlanarField exact = state(kBoth[1], 2000);
  const auto off = [&](PlanarIntegrator kind, int steps) { return largest(along(state(kind, steps), exact, -1.0)); };
  EXPECT_NEAR(off(kBoth[0], 800) / off(kBoth[0], 1600), 2.0, 0.15);
  EXPECT_NEAR(off(kBoth[1], 50) / off(kBoth[1], 100), 16.0, 3.0);
}

TEST(PlanarMotion, held_nodes_move_as_told_and_added_mass_is_accelerated) {
  const PlanarMesh mesh = small_wheel(12, 2);
  for (const PlanarIntegrator kind : kBoth) {
    PlanarMotion motion(wheel_elements(mesh, {}, 300.0), {mesh.position, PlanarField(mesh.position.size())}, kind);
    motion.hold(mesh.centre, true, false);
    motion.set_velocity(mesh.centre, 0.5, 0.0);
    motion.add_mass(mesh.centre, 50.0);
    const double gravity = 9.81;
    motion.set_loads([&](const PlanarState&, double, PlanarField& force) {
      for (std::size_t n = 0; n < force.size(); ++n) force.z[n] -= motion.mass()[n] * gravity;
    });
    const double h = 0.3 * step_limit(motion.elements(), mesh.position);
    const int steps = 400;
    for (int k = 0; k < steps; ++k) ASSERT_TRUE(motion.step(h));
    EXPECT_NEAR(motion.state().x.x[mesh.centre], 0.5 * h * steps, 1e-12);
    EXPECT_NEAR(motion.state().v.z[mesh.centre], -gravity * h * steps, 1e-9);  // all fall equally
    double mass = 0.0;
    for (const double one : motion.mass()) mass += one;
    EXPECT_NEAR(momenta(motion).z, -mass * gravity * h * steps, 1e-9 * mass);
  }
}

}  // namespace
}  // namespace furrow::tire
