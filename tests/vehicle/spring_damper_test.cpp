// Springs and dampers against the discrete recurrence of the step, and against the closed form.
#include <gtest/gtest.h>

#include "protocol/core/constants.hpp"
#include "tests/vehicle/planar.hpp"

using namespace furrow;
using namespace furrow::testing;

namespace {

struct Slider {
  vehicle::System system;
  int body, joint, element;
  Slider(double mass, double k, double rest, double c, double x0, double v0) {
    vehicle::BodyState state;
    state.velocity = Vec3(0.0, 0.0, v0);
    body = system.add_body("mass", mass, Mat3::Identity(), state);
    joint = system.add_joint(vehicle::JointKind::prismatic, "slider", vehicle::kGround, body,
                             slide(Vec3::Zero(), Vec3::UnitZ()));
    element = system.add_joint_element("strut", joint, vehicle::linear_spring_damper(k, rest, c));
    state.position = Vec3(0.0, 0.0, x0);
    system.set_state(body, state);
    system.assemble(0.0);
  }
  double x() const { return system.body(body).state.position.z(); }
  double v() const { return system.body(body).state.velocity.z(); }
};

}  // namespace

TEST(SpringDamper, follows_its_discrete_recurrence) {
  const double m = 450.0, k = 2e5, rest = 0.1, c = 12e3, h = 1e-3;
  Slider slider(m, k, rest, c, 0.05, 0.4);
  double x = 0.05, v = 0.4;
  for (int i = 0; i < 1000; ++i) {
    // v½ = (v₀ + h/2 (−g − k(x₀−rest)/m)) / (1 + h c/(2m)); x₁ = x₀ + h v½; v₁ = v½ + h/2 (−g − (k(x₁−rest) +
    // c v½)/m)
    const double half = (v + 0.5 * h * (-kStandardGravity - k * (x - rest) / m)) / (1.0 + 0.5 * h * c / m);
    const double force = 0.5 * (-k * (x - rest) - c * half);
    x += h * half;
    v = half + 0.5 * h * (-kStandardGravity - (k * (x - rest) + c * half) / m);
    EXPECT_TRUE(slider.system.step(h).ok);
    ASSERT_NEAR(slider.x(), x, 1e-12) << i;
    ASSERT_NEAR(slider.v(), v, 1e-11) << i;
    ASSERT_NEAR(slider.system.element_force(slider.element), force + 0.5 * (-k * (x - rest) - c * half), 1e-6) << i;
  }
}

TEST(SpringDamper, damped_oscillation_matches_closed_form_with_second_order) {
  const double m = 10.0, k = 4000.0, c = 80.0, x0 = 0.2, end = 0.7;
  const double equilibrium = -m * kStandardGravity / k, decay = 0.5 * c / m, w = std::sqrt(k / m - decay * decay);
  const double reference =
      equilibrium + std::exp(-decay * end) * (x0 - equilibrium) * (std::cos(w * end) + decay / w * std::sin(w * end));
  const auto error_of = [&](int steps) {
    Slider slider(m, k, 0.0, c, x0, 0.0);
    for (int i = 0; i < steps; ++i) EXPECT_TRUE(slider.system.step(end / steps).ok);
    return std::abs(slider.x() - reference);
  };
  const double coarse = error_of(200), fine = error_of(400);
  EXPECT_LT(fine, 1e-4);
  EXPECT_NEAR(coarse / fine, 4.0, 0.15);
}

TEST(SpringDamper, damper_far_stiffer_than_the_step_stays_stable) {
  const double m = 1.0, c = 1e7, h = 1e-3;  // h c/m = 1e4
  Slider slider(m, 0.0, 0.0, c, 0.0, 1.0);
  for (int i = 0; i < 1000; ++i) EXPECT_TRUE(slider.system.step(h).ok);
  EXPECT_LT(std::abs(slider.v()), 1.0);
  EXPECT_LT(std::abs(slider.x()), 1e-2);
}

TEST(SpringDamper, line_spring_between_free_bodies_keeps_momentum) {
  vehicle::System system(Vec3::Zero());
  vehicle::BodyState state;
  state.angular_velocity = Vec3(0.3, 1.0, -0.4);
  const int a = system.add_body("a", 2.0, Vec3(0.1, 0.2, 0.3).asDiagonal(), state);
  state.position = Vec3(1.0, 0.2, 0.1);
  state.velocity = Vec3(-0.5, 1.0, 0.2);
  const int b = system.add_body("b", 3.0, Vec3(0.2, 0.2, 0.4).asDiagonal(), state);
  system.add_line_element("spring", a, b, Vec3(0.1, 0.1, 0.0), Vec3(0.9, 0.1, 0.1),
                          vehicle::linear_spring_damper(500.0, 0.5, 3.0));
  system.assemble(0.0);
  const Vec3 momentum = system.momentum(), angular = system.angular_momentum(Vec3::Zero());
  for (int i = 0; i < 2000; ++i) EXPECT_TRUE(system.step(1e-3).ok);
  EXPECT_LT((system.momentum() - momentum).norm(), 1e-12);
  EXPECT_LT((system.angular_momentum(Vec3::Zero()) - angular).norm(), 1e-4 * angular.norm());
}
